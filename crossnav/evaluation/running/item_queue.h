// SPDX-License-Identifier: MIT
// Which item a worker gets next. Items of a group (episodes of a scene) go to one worker as long as
// it has any, so that few workers load the same scene; idle workers help where most is left.
#pragma once

#include <deque>
#include <vector>

namespace crossnav::evaluation {

class ItemQueue {
 public:
  /// `groups` names the group of each item; empty = each item is its own.
  ItemQueue(int count, const std::vector<int>& groups);

  /// Next item of a worker whose last item was `last_item` (-1 = it had none); -1 = none is left.
  int Take(int last_item);

 private:
  struct Group {
    std::deque<int> items;
    bool is_started = false;
  };
  Group* GroupFor(int last_item);

  std::vector<std::size_t> group_of_;
  std::vector<Group> groups_;  // in the order of their first items
};

}  // namespace crossnav::evaluation
