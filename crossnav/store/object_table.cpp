// SPDX-License-Identifier: MIT
#include "crossnav/store/object_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <type_traits>

#include "crossnav/store/sealed_rows.h"

namespace crossnav::store {

using geometry::VoxelKey;
using objects::ObjectRecord;

namespace {

constexpr const char* kObjectTable = "object";
constexpr std::size_t kMaxObjectBytes = 1 << 24;  // chosen: a million voxels
constexpr std::size_t kMaxName = 1000;            // chosen: of a category [bytes]
constexpr std::size_t kMaxPicture = 1 << 17;      // chosen: 64 x 64 pixels need a tenth of it
constexpr double kFarthest_m = 1e6;               // chosen: of a coordinate

class Writer {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void Put(T value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(&bytes_[at], &value, sizeof value);
  }
  void Put(const Vector3d& p) {
    for (const double x : {p.x(), p.y(), p.z()}) Put(x);
  }
  template <class Bytes8>
  void PutBytes(const Bytes8& bytes) {
    Put(static_cast<std::uint32_t>(bytes.size()));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  Bytes Take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Reads in order; after the first value that is not there everything is zero and `ok` false.
class Reader {
 public:
  explicit Reader(ByteView bytes) : bytes_(bytes) {}

  template <class T>
  T Get() {
    T value{};
    if (bytes_.size() < sizeof value) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return value;
  }
  Vector3d Point() {
    const double x = Get<double>(), y = Get<double>(), z = Get<double>();
    for (const double value : {x, y, z}) ok_ = ok_ && std::abs(value) <= kFarthest_m;
    return {x, y, z};
  }
  ByteView GetBytes(std::size_t most) {
    const auto count = Get<std::uint32_t>();
    if (count > std::min(most, bytes_.size())) {
      ok_ = false;
      return {};
    }
    const ByteView out = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return out;
  }
  std::size_t left() const { return bytes_.size(); }
  bool ok() const { return ok_; }
  bool IsDone() const { return ok_ && bytes_.empty(); }

 private:
  ByteView bytes_;
  bool ok_ = true;
};

bool IsSound(const ObjectRecord& r) {
  return r.id >= 0 && r.floor >= -1 && r.room >= -1 && r.views >= 0 && r.first_seen_step >= 0 &&
         r.last_seen_step >= 0 && r.first_seen_day >= 0 && r.last_seen_day >= r.first_seen_day &&
         r.confidence >= 0 && r.confidence <= 1 && !r.category.empty() &&
         std::is_sorted(r.voxels.begin(), r.voxels.end());
}

}  // namespace

Bytes EncodeObject(const ObjectRecord& record) {
  Writer out;
  for (const int number : {record.id, record.floor, record.room, record.views,
                           record.first_seen_day, record.last_seen_day})
    out.Put(static_cast<std::int32_t>(number));
  out.Put(record.first_seen_step);
  out.Put(record.last_seen_step);
  out.Put(record.confidence);
  out.Put(record.centre_world_m);
  out.Put(Vector3d(record.box_world_m.min()));
  out.Put(Vector3d(record.box_world_m.max()));
  out.Put(static_cast<std::uint8_t>(record.colour ? 1 : 0));
  for (std::size_t i = 0; i < 3; ++i)
    out.Put(static_cast<std::uint8_t>(record.colour ? (*record.colour)[i] : 0));
  out.PutBytes(record.category);
  out.PutBytes(record.picture_png);
  out.Put(static_cast<std::uint32_t>(record.voxels.size()));
  for (const VoxelKey& key : record.voxels)
    for (const std::int32_t index : {key.x, key.y, key.z}) out.Put(index);
  return out.Take();
}

std::optional<ObjectRecord> DecodeObject(ByteView raw) {
  Reader in(raw);
  ObjectRecord record;
  for (int* number : {&record.id, &record.floor, &record.room, &record.views,
                      &record.first_seen_day, &record.last_seen_day})
    *number = in.Get<std::int32_t>();
  record.first_seen_step = in.Get<std::int64_t>();
  record.last_seen_step = in.Get<std::int64_t>();
  record.confidence = in.Get<double>();
  record.centre_world_m = in.Point();
  record.box_world_m.min() = in.Point();
  record.box_world_m.max() = in.Point();
  const auto has_colour = in.Get<std::uint8_t>();
  std::array<std::uint8_t, 3> colour{};
  for (std::uint8_t& value : colour) value = in.Get<std::uint8_t>();
  if (has_colour == 1) record.colour = colour;
  const ByteView name = in.GetBytes(kMaxName);
  record.category.assign(name.begin(), name.end());
  const ByteView picture = in.GetBytes(kMaxPicture);
  record.picture_png.assign(picture.begin(), picture.end());
  constexpr std::size_t kKey = 3 * sizeof(std::int32_t);
  const auto voxels = in.Get<std::uint32_t>();
  if (!in.ok() || has_colour > 1 || in.left() != kKey * voxels) return std::nullopt;
  while (in.left() > 0) {
    const auto x = in.Get<std::int32_t>(), y = in.Get<std::int32_t>(), z = in.Get<std::int32_t>();
    record.voxels.push_back({x, y, z});
  }
  if (!in.IsDone() || !IsSound(record)) return std::nullopt;
  return record;
}

Result<void> WriteObjects(Database& db, const std::vector<ObjectRecord>& records) {
  if (auto done = ReplaceTable(db, kObjectTable, records.empty()); !done) return done;
  std::int64_t row = 0;
  for (const ObjectRecord& record : records)
    if (auto done = InsertRow(db, kObjectTable, row++, EncodeObject(record)); !done) return done;
  return {};
}

std::vector<ObjectRecord> ReadObjects(Database& db, std::vector<std::string>& damaged) {
  std::vector<ObjectRecord> records;
  std::set<int> ids;
  ForEachRow(db, kObjectTable, kMaxObjectBytes, damaged, [&](std::int64_t, const Bytes& bytes) {
    auto record = DecodeObject(bytes);
    if (!record || !ids.insert(record->id).second) return false;
    records.push_back(std::move(*record));
    return true;
  });
  return records;
}

}  // namespace crossnav::store
