// SPDX-License-Identifier: MIT
// Common code of all bindings: errors as exceptions, settings in all their forms, NumPy arrays in
// and out. Results become values or raise crossnav.Error; a call that would abort in a
// CROSSNAV_CHECK is refused here first, because a user's mistake must not end the interpreter.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>
#include <array>
#include <atomic>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "crossnav/core/observation.h"
#include "crossnav/core/result.h"
#include "crossnav/evaluation/settings/run_config.h"
#include "crossnav/geometry/voxel_key.h"

namespace crossnav::python {

namespace nb = nanobind;
using namespace nb::literals;  // NOLINT: "name"_a throughout

/// Reaches Python as crossnav.Error.
struct Failure {
  Error error;
};

[[noreturn]] inline void Raise(ErrorCode code, std::string what, std::string where = {}) {
  throw Failure{{code, std::move(what), std::move(where)}};
}

template <class T>
T Unwrap(Result<T> result) {
  if (!result) throw Failure{std::move(result.error())};
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Objects for one thread at a time, while slow calls let other threads run.
class InUse {
 public:
  explicit InUse(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true))
      Raise(ErrorCode::kInvalid, "is in use by another call; one thread at a time", "object");
  }
  ~InUse() { flag_ = false; }
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  std::atomic<bool>& flag_;
};

// --- Settings -----------------------------------------------------------------------------------

/// Any form of configuration from a user; crossnav/_config.py lists them.
struct Settings {
  nb::object value = nb::none();
};

/// The paper's defaults with these settings on top. Problems raise with the program's text.
evaluation::RunConfig ConfigOf(const Settings& settings);

/// A path from a user; a separate name for its type in Python.
struct PathIn {
  std::filesystem::path path;
};

/// A point from a user: three numbers in a tuple, a list or an array.
struct Point {
  std::array<double, 3> xyz{};
};

// --- Arrays -------------------------------------------------------------------------------------

using RgbIn = nb::ndarray<const std::uint8_t, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using DepthIn = nb::ndarray<const float, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using PoseIn = nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;
using VectorIn = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using GridIn = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

template <class T, class... Shape>
using Array = nb::ndarray<nb::numpy, T, Shape..., nb::c_contig>;
using PoseOut = Array<double, nb::shape<4, 4>>;
using PointOut = Array<double, nb::shape<3>>;
using KeysOut = Array<std::int32_t, nb::shape<-1, 3>>;

/// For properties that return arrays of their own, not views of the object.
inline constexpr auto kOwnArray = nb::rv_policy::automatic;

/// A NumPy array that owns `data`, which moves into it.
template <class Out, class T>
Out ToArray(std::vector<T> data, std::initializer_list<std::size_t> shape) {
  auto* held = new std::vector<T>(std::move(data));
  nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return Out(held->data(), shape, owner);
}

inline PointOut ToArray(const Vector3d& p) {
  return ToArray<PointOut>(std::vector<double>(p.data(), p.data() + 3), {3});
}
PoseOut ToArray(const Pose& T);
KeysOut ToArray(std::span<const geometry::VoxelKey> keys);

/// Raises unless the point is finite.
Vector3d ToPoint(const Point& p, const char* name);
/// Raises, naming `key`, unless it is a finite rigid transform within the map's reach.
Pose ToPose(const PoseIn& T, const char* key = "observation.T_world_camera");
DepthImage ToImage(const DepthIn& depth_m);
/// Raises unless the intrinsics are finite and of this size.
void CheckCamera(const CameraIntrinsics& camera, std::size_t rows, std::size_t cols);

/// The Python object behind this observation; a copy if there is none.
nb::object ToPython(const Observation& obs);

/// json.loads(text)
nb::object FromJson(const std::string& text);

// --- One function per file ----------------------------------------------------------------------

void BindCore(nb::module_& m);
void BindGeometry(nb::module_& m);
void BindMemory(nb::module_& m);
void BindPerception(nb::module_& m);
void BindHooks(nb::module_& m);
void BindAgent(nb::module_& m);
void BindSimulator(nb::module_& m);
void BindStore(nb::module_& m);
void BindLanguage(nb::module_& m);
void BindRecordings(nb::module_& m);
void BindBench(nb::module_& m);

}  // namespace crossnav::python

namespace nanobind::detail {

template <>
struct type_caster<crossnav::python::Settings> {
  NB_TYPE_CASTER(crossnav::python::Settings, const_name("crossnav._config.Settings"))

  bool from_python(handle source, std::uint32_t, cleanup_list*) noexcept {
    value.value = borrow(source);
    return true;
  }
};

template <>
struct type_caster<crossnav::python::Point> {
  NB_TYPE_CASTER(crossnav::python::Point,
                 const_name("collections.abc.Sequence[float] | numpy.typing.NDArray[typing.Any]"))

  bool from_python(handle source, std::uint32_t flags, cleanup_list* cleanup) noexcept {
    make_caster<std::array<double, 3>> inner;
    if (!inner.from_python(source, flags, cleanup)) return false;
    value.xyz = inner.value;
    return true;
  }
};

template <>
struct type_caster<crossnav::python::PathIn> {
  NB_TYPE_CASTER(crossnav::python::PathIn, const_name("str | os.PathLike[str]"))

  bool from_python(handle source, std::uint32_t flags, cleanup_list* cleanup) noexcept {
    make_caster<std::filesystem::path> inner;
    if (!inner.from_python(source, flags, cleanup)) return false;
    value.path = std::move(inner.value);
    return true;
  }
};

}  // namespace nanobind::detail
