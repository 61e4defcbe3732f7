// SPDX-License-Identifier: MIT
#include "crossnav/store/stair_tables.h"

#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "crossnav/store/sealed_blob.h"

namespace crossnav::store {
namespace {

constexpr const char* kFlightTable = "flight";
constexpr const char* kSeenTable = "seen_stair";
constexpr std::size_t kMaxBytes = 1 << 20;      // chosen: forty thousand steps
constexpr std::size_t kMaxSeenBytes = 1 << 26;  // chosen: three million voxels
constexpr std::size_t kSeenBytes = 21;          // of one voxel
constexpr std::size_t kFixed = 9;               // numbers before the steps

/// Little-endian doubles: foot, top, confidence, walks up and down, then the steps.
Bytes Encode(const geometry::StairFlight& flight) {
  std::vector<double> numbers;
  const auto put = [&](const Vector3d& p) { numbers.insert(numbers.end(), {p.x(), p.y(), p.z()}); };
  put(flight.p_foot_world);
  put(flight.p_top_world);
  numbers.insert(numbers.end(), {flight.confidence, static_cast<double>(flight.walked_up),
                                 static_cast<double>(flight.walked_down)});
  for (const Vector3d& step : flight.steps_world) put(step);
  Bytes bytes(numbers.size() * sizeof(double));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::optional<geometry::StairFlight> Decode(const Bytes& bytes) {
  if (bytes.size() % sizeof(double) != 0) return std::nullopt;
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  if (numbers.size() < kFixed || (numbers.size() - kFixed) % 3 != 0) return std::nullopt;
  for (const double number : numbers)
    if (!std::isfinite(number) || std::abs(number) > 1e9) return std::nullopt;
  geometry::StairFlight flight;
  flight.p_foot_world = Vector3d(numbers[0], numbers[1], numbers[2]);
  flight.p_top_world = Vector3d(numbers[3], numbers[4], numbers[5]);
  flight.confidence = numbers[6];
  flight.walked_up = static_cast<int>(numbers[7]);
  flight.walked_down = static_cast<int>(numbers[8]);
  for (std::size_t i = kFixed; i < numbers.size(); i += 3)
    flight.steps_world.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return flight;
}

/// Each voxel: key (3 x i32), probability and geometry score (f32), confirmed (u8); little-endian.
Bytes Encode(const std::vector<geometry::SeenStair>& seen) {
  Bytes bytes(seen.size() * kSeenBytes);
  auto* at = bytes.data();
  for (const geometry::SeenStair& stair : seen) {
    const std::array<std::int32_t, 3> key{stair.key.x, stair.key.y, stair.key.z};
    const std::array<float, 2> scores{stair.probability, stair.geometry_score};
    const auto confirmed = static_cast<std::uint8_t>(stair.is_confirmed);
    std::memcpy(at, key.data(), 12);
    std::memcpy(at + 12, scores.data(), 8);
    std::memcpy(at + 20, &confirmed, 1);
    at += kSeenBytes;
  }
  return bytes;
}

std::optional<std::vector<geometry::SeenStair>> DecodeSeen(const Bytes& bytes) {
  if (bytes.size() % kSeenBytes != 0) return std::nullopt;
  std::vector<geometry::SeenStair> seen;
  for (const auto* at = bytes.data(); at != bytes.data() + bytes.size(); at += kSeenBytes) {
    std::array<std::int32_t, 3> key{};
    std::array<float, 2> scores{};
    std::uint8_t confirmed = 0;
    std::memcpy(key.data(), at, 12);
    std::memcpy(scores.data(), at + 12, 8);
    std::memcpy(&confirmed, at + 20, 1);
    for (const float score : scores)
      if (!(score >= 0 && score <= 1)) return std::nullopt;
    if (confirmed > 1) return std::nullopt;
    seen.push_back({{key[0], key[1], key[2]}, scores[0], scores[1], confirmed == 1});
  }
  return seen;
}

Result<void> Replace(Database& db, const char* table, bool is_empty) {
  auto done = db.Exec(std::string("DROP TABLE IF EXISTS ") + table);
  if (!done || is_empty) return done;
  return db.Exec(std::string("CREATE TABLE ") + table +
                 "(id INTEGER PRIMARY KEY, hash INTEGER, data BLOB) STRICT");
}

Result<void> Insert(Database& db, const char* table, std::int64_t id, const Bytes& raw) {
  auto insert = db.Prepare(std::string("INSERT INTO ") + table + " VALUES(?1,?2,?3)");
  if (!insert) return tl::unexpected(insert.error());
  const Bytes data = Compress(raw);
  insert->Bind(1, id).Bind(2, HashBlock({table, id, {}, 0}, data)).Bind(3, ByteView(data));
  return insert->Run();
}

}  // namespace

Result<void> WriteFlights(Database& db, const std::vector<geometry::StairFlight>& flights) {
  if (auto done = Replace(db, kFlightTable, flights.empty()); !done) return done;
  std::int64_t id = 0;
  for (const geometry::StairFlight& flight : flights)
    if (auto done = Insert(db, kFlightTable, id++, Encode(flight)); !done) return done;
  return {};
}

Result<std::vector<geometry::StairFlight>> ReadFlights(Database& db,
                                                       std::vector<std::string>& damaged) {
  std::vector<geometry::StairFlight> flights;
  auto select =
      db.Prepare(std::string("SELECT id, hash, data FROM ") + kFlightTable + " ORDER BY id");
  if (!select) return flights;  // no such table
  for (;;) {
    const auto row = select->Step();
    if (!row) {
      damaged.push_back("flights: " + row.error().what);
      return flights;
    }
    if (!*row) return flights;
    const std::int64_t id = select->Int(0);
    const ByteView data = select->Blob(2);
    std::optional<geometry::StairFlight> flight;
    if (select->Int(1) == HashBlock({kFlightTable, id, {}, 0}, data))
      if (const auto raw = Decompress(data, kMaxBytes)) flight = Decode(*raw);
    if (flight)
      flights.push_back(std::move(*flight));
    else
      damaged.push_back("flight " + std::to_string(id) + ": checksum differs");
  }
}

Result<void> WriteSeenStairs(Database& db, const std::vector<geometry::SeenStair>& seen) {
  auto done = Replace(db, kSeenTable, seen.empty());
  return !done || seen.empty() ? done : Insert(db, kSeenTable, 0, Encode(seen));
}

std::vector<geometry::SeenStair> ReadSeenStairs(Database& db, std::vector<std::string>& damaged) {
  auto select = db.Prepare(std::string("SELECT hash, data FROM ") + kSeenTable + " WHERE id = 0");
  if (!select) return {};  // no such table
  const auto row = select->Step();
  if (row && !*row) return {};
  if (row && select->Int(0) == HashBlock({kSeenTable, 0, {}, 0}, select->Blob(1)))
    if (const auto raw = Decompress(select->Blob(1), kMaxSeenBytes))
      if (auto seen = DecodeSeen(*raw)) return std::move(*seen);
  damaged.push_back("seen stairs: checksum differs");
  return {};
}

}  // namespace crossnav::store
