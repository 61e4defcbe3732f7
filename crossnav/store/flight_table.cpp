// SPDX-License-Identifier: MIT
#include "crossnav/store/flight_table.h"

#include <cmath>
#include <cstring>
#include <optional>

#include "crossnav/store/sealed_blob.h"

namespace crossnav::store {
namespace {

constexpr const char* kTable = "flight";
constexpr std::size_t kMaxBytes = 1 << 20;  // chosen: forty thousand steps
constexpr std::size_t kFixed = 9;           // numbers before the steps

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

}  // namespace

Result<void> WriteFlights(Database& db, const std::vector<geometry::StairFlight>& flights) {
  if (auto done = db.Exec(std::string("DROP TABLE IF EXISTS ") + kTable); !done) return done;
  if (flights.empty()) return {};
  if (auto done = db.Exec(std::string("CREATE TABLE ") + kTable +
                          "(id INTEGER PRIMARY KEY, hash INTEGER, data BLOB) STRICT");
      !done)
    return done;
  auto insert = db.Prepare(std::string("INSERT INTO ") + kTable + " VALUES(?1,?2,?3)");
  if (!insert) return tl::unexpected(insert.error());
  std::int64_t id = 0;
  for (const geometry::StairFlight& flight : flights) {
    const Bytes data = Compress(Encode(flight));
    insert->Bind(1, id).Bind(2, HashBlock({kTable, id, {}, 0}, data)).Bind(3, ByteView(data));
    if (auto done = insert->Run(); !done) return done;
    ++id;
  }
  return {};
}

Result<std::vector<geometry::StairFlight>> ReadFlights(Database& db,
                                                       std::vector<std::string>& damaged) {
  std::vector<geometry::StairFlight> flights;
  auto select = db.Prepare(std::string("SELECT id, hash, data FROM ") + kTable + " ORDER BY id");
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
    if (select->Int(1) == HashBlock({kTable, id, {}, 0}, data))
      if (const auto raw = Decompress(data, kMaxBytes)) flight = Decode(*raw);
    if (flight)
      flights.push_back(std::move(*flight));
    else
      damaged.push_back("flight " + std::to_string(id) + ": checksum differs");
  }
}

}  // namespace crossnav::store
