// SPDX-License-Identifier: MIT
#include "crossnav/store/stair_tables.h"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

#include "crossnav/store/sealed_rows.h"

namespace crossnav::store {
namespace {

constexpr const char* kFlightTable = "flight";
constexpr const char* kSeenTable = "seen_stair";
constexpr std::size_t kMaxStairBytes = 1 << 20;  // chosen: forty thousand steps
constexpr std::size_t kMaxSeenBytes = 1 << 26;   // chosen: three million voxels
constexpr std::size_t kSeenBytes = 21;           // of one voxel
constexpr std::size_t kFixed = 9;                // numbers before the steps

constexpr const char* kPlacesTable = "flight_places";

/// Little-endian doubles.
Bytes Encode(const std::vector<double>& numbers) {
  Bytes bytes(numbers.size() * sizeof(double));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// Inverse of Encode; nullopt where the bytes are no list of sane numbers.
std::optional<std::vector<double>> DecodeNumbers(const Bytes& bytes) {
  if (bytes.size() % sizeof(double) != 0) return std::nullopt;
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  for (const double number : numbers)
    if (!std::isfinite(number) || std::abs(number) > 1e9) return std::nullopt;
  return numbers;
}

void Put(const Vector3d& p, std::vector<double>* numbers) {
  numbers->insert(numbers->end(), {p.x(), p.y(), p.z()});
}

/// Foot, top, confidence, walks up and down, then the steps.
Bytes Encode(const geometry::StairFlight& flight) {
  std::vector<double> numbers;
  Put(flight.p_foot_world, &numbers);
  Put(flight.p_top_world, &numbers);
  numbers.insert(numbers.end(), {flight.confidence, static_cast<double>(flight.walked_up),
                                 static_cast<double>(flight.walked_down)});
  for (const Vector3d& step : flight.steps_world) Put(step, &numbers);
  return Encode(numbers);
}

std::optional<geometry::StairFlight> DecodeFlight(const Bytes& bytes) {
  const auto numbers = DecodeNumbers(bytes);
  if (!numbers || numbers->size() < kFixed || (numbers->size() - kFixed) % 3 != 0)
    return std::nullopt;
  const auto& n = *numbers;
  geometry::StairFlight flight;
  flight.p_foot_world = Vector3d(n[0], n[1], n[2]);
  flight.p_top_world = Vector3d(n[3], n[4], n[5]);
  flight.confidence = n[6];
  flight.walked_up = static_cast<int>(n[7]);
  flight.walked_down = static_cast<int>(n[8]);
  for (std::size_t i = kFixed; i < n.size(); i += 3)
    flight.steps_world.emplace_back(n[i], n[i + 1], n[i + 2]);
  return flight;
}

/// Id, number of viewing places, the places, then per try: place, 1 for up, ending.
Bytes EncodePlaces(const geometry::StairFlight& flight) {
  std::vector<double> numbers{static_cast<double>(flight.id),
                              static_cast<double>(flight.seen_from_world.size())};
  for (const Vector3d& place : flight.seen_from_world) Put(place, &numbers);
  for (const geometry::FlightTry& attempt : flight.tries) {
    Put(attempt.p_from_world, &numbers);
    numbers.push_back(attempt.is_up ? 1 : 0);
    numbers.push_back(static_cast<double>(attempt.ending));
  }
  return Encode(numbers);
}

/// On malformed bytes returns false and leaves `flight` unchanged.
bool DecodePlaces(const Bytes& bytes, geometry::StairFlight* flight) {
  const auto numbers = DecodeNumbers(bytes);
  if (!numbers || numbers->size() < 2) return false;
  geometry::StairFlight read = *flight;
  std::size_t at = 0;
  const auto left = [&] { return numbers->size() - at; };
  const auto next = [&] { return (*numbers)[at++]; };
  const auto point = [&] {
    const double x = next(), y = next(), z = next();
    return Vector3d(x, y, z);
  };
  read.id = static_cast<int>(next());
  const double places = next();
  if (read.id < 0 || !(places >= 0 && 3 * places <= static_cast<double>(left()))) return false;
  for (int i = 0; i < static_cast<int>(places); ++i) read.seen_from_world.push_back(point());
  constexpr std::size_t kTry = 5;  // numbers per try
  if (left() % kTry != 0) return false;
  while (left() > 0) {
    geometry::FlightTry attempt;
    attempt.p_from_world = point();
    attempt.is_up = next() == 1;
    const double ending = next();
    if (!(ending >= 0 && ending < geometry::kTryEndings)) return false;
    attempt.ending = static_cast<geometry::TryEnding>(static_cast<int>(ending));
    read.tries.push_back(attempt);
  }
  *flight = std::move(read);
  return true;
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

}  // namespace

Result<void> WriteFlights(Database& db, const std::vector<geometry::StairFlight>& flights) {
  for (const char* table : {kFlightTable, kPlacesTable})
    if (auto done = ReplaceTable(db, table, flights.empty()); !done) return done;
  std::int64_t row = 0;
  for (const geometry::StairFlight& flight : flights) {
    if (auto done = InsertRow(db, kFlightTable, row, Encode(flight)); !done) return done;
    if (auto done = InsertRow(db, kPlacesTable, row, EncodePlaces(flight)); !done) return done;
    ++row;
  }
  return {};
}

std::vector<geometry::StairFlight> ReadFlights(Database& db, std::vector<std::string>& damaged) {
  std::map<std::int64_t, geometry::StairFlight> flights;
  ForEachRow(db, kFlightTable, kMaxStairBytes, damaged, [&](std::int64_t row, const Bytes& bytes) {
    auto flight = DecodeFlight(bytes);
    if (!flight) return false;
    flight->id = static_cast<int>(row);  // older files lack ids
    flights.emplace(row, std::move(*flight));
    return true;
  });
  ForEachRow(db, kPlacesTable, kMaxStairBytes, damaged, [&](std::int64_t row, const Bytes& bytes) {
    const auto it = flights.find(row);
    return it == flights.end() || DecodePlaces(bytes, &it->second);
  });
  std::vector<geometry::StairFlight> out;
  out.reserve(flights.size());
  for (auto& [row, flight] : flights) out.push_back(std::move(flight));
  return out;
}

Result<void> WriteSeenStairs(Database& db, const std::vector<geometry::SeenStair>& seen) {
  auto done = ReplaceTable(db, kSeenTable, seen.empty());
  return !done || seen.empty() ? done : InsertRow(db, kSeenTable, 0, Encode(seen));
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
