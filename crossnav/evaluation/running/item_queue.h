// SPDX-License-Identifier: MIT
// Assigns items to workers. Items of a group (episodes of a scene) go to one worker while any are
// left, so that few workers load the same scene; idle workers join the group with the most items
// left.
#pragma once

#include <deque>
#include <vector>

namespace crossnav::evaluation {

class ItemQueue {
 public:
  /// `groups`: group of each item; empty = each item is its own group.
  ItemQueue(int count, const std::vector<int>& groups);

  /// Next item of a worker with last item `last_item` (-1 = none yet); -1 = no item is left.
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
