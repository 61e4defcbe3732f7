// SPDX-License-Identifier: MIT
#include "crossnav/evaluation/running/item_queue.h"

#include <algorithm>
#include <map>

#include "crossnav/core/check.h"

namespace crossnav::evaluation {

ItemQueue::ItemQueue(int count, const std::vector<int>& groups) {
  CROSSNAV_CHECK(groups.empty() || static_cast<int>(groups.size()) == count,
                 "every item needs a group");
  std::map<int, std::size_t> index;
  for (int item = 0; item < count; ++item) {
    const int name = groups.empty() ? item : groups[static_cast<std::size_t>(item)];
    const auto [entry, is_new] = index.emplace(name, groups_.size());
    if (is_new) groups_.emplace_back();
    groups_[entry->second].items.push_back(item);
    group_of_.push_back(entry->second);
  }
}

ItemQueue::Group* ItemQueue::GroupFor(int last_item) {
  if (last_item >= 0) {
    Group& own = groups_[group_of_[static_cast<std::size_t>(last_item)]];
    if (!own.items.empty()) return &own;
  }
  Group* fullest = nullptr;
  for (Group& group : groups_) {
    if (group.items.empty()) continue;
    if (!group.is_started) return &group;
    if (fullest == nullptr || group.items.size() > fullest->items.size()) fullest = &group;
  }
  return fullest;
}

int ItemQueue::Take(int last_item) {
  Group* group = GroupFor(last_item);
  if (group == nullptr) return -1;
  group->is_started = true;
  const int item = group->items.front();
  group->items.pop_front();
  return item;
}

}  // namespace crossnav::evaluation
