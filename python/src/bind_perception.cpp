// SPDX-License-Identifier: MIT
// Detector, Segmenter, StairSegmenter and DenseEncoder as base classes for Python. Results from
// Python are checked here, because the rooms below trust their shapes.
#include <nanobind/stl/pair.h>
#include <nanobind/trampoline.h>

#include "crossnav/core/colour_grid.h"
#include "perception_handle.h"

namespace crossnav::python {

using perception::DenseEncoder;
using perception::Detection;
using perception::Detector;
using perception::FeatureGrid;
using perception::PerceptionSuite;
using perception::PixelBox;
using perception::Segmenter;
using perception::StairSegmenter;

namespace {

using Box = std::array<int, 4>;
using MaskIn = nb::ndarray<const std::uint8_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using MaskOut = Array<std::uint8_t, nb::ndim<2>>;
using ProbabilityOut = Array<float, nb::ndim<2>>;
using GridOut = Array<float, nb::ndim<3>>;
using VectorOut = Array<float, nb::ndim<1>>;

[[noreturn]] void Wrong(const char* what, const char* where) {
  Raise(ErrorCode::kInvalid, what, where);
}

/// Like `Array`, for any dtype that NumPy converts.
template <class In>
In ArrayFrom(const nb::object& value, const char* dtype, const char* where) {
  In array;
  const nb::object converted =
      nb::module_::import_("numpy").attr("ascontiguousarray")(value, dtype);
  if (!nb::try_cast(converted, array)) Wrong("is an array of the wrong shape", where);
  return array;
}

template <class T, class Out>
Out ImageOut(Image<T> image) {
  const auto rows = static_cast<std::size_t>(image.height);
  const auto cols = static_cast<std::size_t>(image.width);
  return ToArray<Out>(std::move(image.data), {rows, cols});
}

bool HasSizeOf(std::size_t rows, std::size_t cols, const Observation& obs) {
  return static_cast<int>(rows) == obs.depth_m.height &&
         static_cast<int>(cols) == obs.depth_m.width;
}

void CheckDetection(const Detection& d, const Observation& obs) {
  const PixelBox& b = d.box;
  if (b.u0 < 0 || b.v0 < 0 || b.u1 > obs.depth_m.width || b.v1 > obs.depth_m.height ||
      b.u0 >= b.u1 || b.v0 >= b.v1)
    Wrong("a box must lie in the image and not be empty", "Detector.detect");
  if (!(d.confidence >= 0 && d.confidence <= 1))
    Wrong("a confidence must lie in [0, 1]", "Detector.detect");
}

/// Calls f(obs) with colour on the grid of depth, as the agent passes it to perception.
template <class F>
auto OnOneGrid(const Observation& obs, F f) {
  return HasOwnColourGrid(obs) ? f(WithColourOnDepthGrid(obs)) : f(obs);
}

// --- Python behind the C++ interfaces -----------------------------------------------------------

/// Calls method `name` of the Python object behind a trampoline; refuses an undefined method.
#define CROSSNAV_CALL_PYTHON(name, ...)                                            \
  constexpr std::uint64_t nb_hash = nb::detail::str_hash(name);                    \
  const nb::detail::ticket nb_ticket(nb_trampoline, name, nb_hash, /*pure=*/true); \
  const nb::object answer = nb_trampoline.base().attr(nb_ticket.key)(__VA_ARGS__)

class PythonDetector : public Detector {
 public:
  NB_TRAMPOLINE(Detector);

  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) override {
    const nb::gil_scoped_acquire python;
    CROSSNAV_CALL_PYTHON("detect", ToPython(obs), goal);
    std::vector<Detection> detections;
    for (const nb::handle item : answer) {
      if (!nb::isinstance<Detection>(item))
        Wrong("must return crossnav.Detection objects", "Detector.detect");
      const auto& detection = nb::cast<const Detection&>(item);
      CheckDetection(detection, obs);
      detections.push_back({detection.box, detection.confidence, {}, 0});
    }
    return detections;
  }
};

class PythonSegmenter : public Segmenter {
 public:
  NB_TRAMPOLINE(Segmenter);

  Result<void> Segment(const Observation& obs, Detection& detection) override {
    const nb::gil_scoped_acquire python;
    const PixelBox& b = detection.box;
    CROSSNAV_CALL_PYTHON("segment", ToPython(obs), nb::make_tuple(b.u0, b.v0, b.u1, b.v1));
    std::pair<nb::object, float> parts;
    if (!nb::try_cast(answer, parts))
      Wrong("must return a mask and its quality", "Segmenter.segment");
    const auto& [mask_object, quality] = parts;
    const auto mask = ArrayFrom<MaskIn>(mask_object, "uint8", "Segmenter.segment");
    if (!HasSizeOf(mask.shape(0), mask.shape(1), obs))
      Wrong("the mask must have the image's size", "Segmenter.segment");
    detection.mask = MaskImage(obs.depth_m.width, obs.depth_m.height);
    for (std::size_t i = 0; i < mask.size(); ++i)
      detection.mask.data[i] = mask.data()[i] != 0 ? 1 : 0;
    detection.mask_quality = quality;
    return {};
  }
};

class PythonStairs : public StairSegmenter {
 public:
  NB_TRAMPOLINE(StairSegmenter);

  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    const nb::gil_scoped_acquire python;
    CROSSNAV_CALL_PYTHON("segment_stairs", ToPython(obs));
    const auto values = ArrayFrom<DepthIn>(answer, "float32", "StairSegmenter.segment_stairs");
    if (!HasSizeOf(values.shape(0), values.shape(1), obs))
      Wrong("the probability must have the image's size", "StairSegmenter.segment_stairs");
    return ToImage(values);
  }
};

class PythonEncoder : public DenseEncoder {
 public:
  NB_TRAMPOLINE(DenseEncoder);

  int Dim() const override {
    if (dim_ > 0) return dim_;
    const nb::gil_scoped_acquire python;
    CROSSNAV_CALL_PYTHON("dim");
    const int dim = nb::cast<int>(answer);
    if (dim < 1 || dim > 65536) Wrong("must be 1 to 65536", "DenseEncoder.dim");
    return dim_ = dim;
  }
  std::string Name() const override {
    const nb::gil_scoped_acquire python;
    CROSSNAV_CALL_PYTHON("name");
    return nb::cast<std::string>(answer);
  }
  Result<FeatureGrid> EncodeImage(const Observation& obs) override {
    const nb::gil_scoped_acquire python;
    CROSSNAV_CALL_PYTHON("encode_image", ToPython(obs));
    const auto grid = ArrayFrom<GridIn>(answer, "float32", "DenseEncoder.encode_image");
    const int dim = Dim();
    if (grid.size() == 0 || static_cast<int>(grid.shape(2)) != dim)
      Wrong("must be rows x cols x dim()", "DenseEncoder.encode_image");
    return FeatureGrid{static_cast<int>(grid.shape(0)), static_cast<int>(grid.shape(1)), dim,
                       std::vector<float>(grid.data(), grid.data() + grid.size())};
  }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    const nb::gil_scoped_acquire python;
    CROSSNAV_CALL_PYTHON("encode_text", text);
    const auto vector = ArrayFrom<VectorIn>(answer, "float32", "DenseEncoder.encode_text");
    if (static_cast<int>(vector.size()) != Dim())
      Wrong("must be a vector of dim() numbers", "DenseEncoder.encode_text");
    return std::vector<float>(vector.data(), vector.data() + vector.size());
  }

 private:
  mutable int dim_ = 0;  // cached: memories do not change their dimension
};

#undef CROSSNAV_CALL_PYTHON

// --- Perception of an agent: forwards to objects that Python owns ------------------------------

struct DetectorLink : Detector {
  explicit DetectorLink(Detector& to) : target(to) {}
  Result<std::vector<Detection>> Detect(const Observation& obs, std::string_view goal) override {
    return target.Detect(obs, goal);
  }
  Detector& target;
};
struct SegmenterLink : Segmenter {
  explicit SegmenterLink(Segmenter& to) : target(to) {}
  Result<void> Segment(const Observation& obs, Detection& detection) override {
    return target.Segment(obs, detection);
  }
  Segmenter& target;
};
struct StairsLink : StairSegmenter {
  explicit StairsLink(StairSegmenter& to) : target(to) {}
  Result<Image<float>> SegmentStairs(const Observation& obs) override {
    return target.SegmentStairs(obs);
  }
  StairSegmenter& target;
};
struct EncoderLink : DenseEncoder {
  explicit EncoderLink(DenseEncoder& to) : target(to) {}
  int Dim() const override { return target.Dim(); }
  std::string Name() const override { return target.Name(); }
  Result<FeatureGrid> EncodeImage(const Observation& obs) override {
    return target.EncodeImage(obs);
  }
  Result<std::vector<float>> EncodeText(std::string_view text) override {
    return target.EncodeText(text);
  }
  DenseEncoder& target;
};

void BindDetection(nb::module_& m) {
  nb::class_<Detection>(m, "Detection", "A box [u0, u1) x [v0, v1) in pixels and how sure it is.")
      .def(
          "__init__",
          [](Detection* self, const Box& box, float confidence) {
            new (self) Detection{{box[0], box[1], box[2], box[3]}, confidence, {}, 0};
          },
          "box"_a, "confidence"_a, "box: (u0, v0, u1, v1). confidence: [0, 1].")
      .def_prop_ro(
          "box",
          [](const Detection& d) { return nb::make_tuple(d.box.u0, d.box.v0, d.box.u1, d.box.v1); },
          nb::sig("def box(self) -> tuple[int, int, int, int]"))
      .def_ro("confidence", &Detection::confidence);
}

void BindFinders(nb::module_& m) {
  nb::class_<Detector, PythonDetector>(m, "Detector", "Finds boxes of one category.")
      .def(nb::init<>())
      .def(
          "detect",
          [](Detector& self, const Observation& obs, const std::string& goal) {
            return OnOneGrid(
                obs, [&](const Observation& seen) { return Unwrap(self.Detect(seen, goal)); });
          },
          "observation"_a, "goal"_a, "Detections of `goal` in the image.");
  nb::class_<Segmenter, PythonSegmenter>(m, "Segmenter", "Turns a box into a mask.")
      .def(nb::init<>())
      .def(
          "segment",
          [](Segmenter& self, const Observation& obs, const Box& box) {
            Detection d{{box[0], box[1], box[2], box[3]}, 0, {}, 0};
            CheckDetection(d, obs);
            OnOneGrid(obs, [&](const Observation& seen) { Unwrap(self.Segment(seen, d)); });
            return nb::make_tuple(ImageOut<std::uint8_t, MaskOut>(std::move(d.mask)),
                                  d.mask_quality);
          },
          nb::sig("def segment(self, observation: Observation, box: tuple[int, int, int, int]) -> "
                  "tuple[numpy.typing.NDArray[typing.Any], float]"),
          "Mask (H x W, 0 or not) of the object in the box (u0, v0, u1, v1), and its quality [0, "
          "1].");
  nb::class_<StairSegmenter, PythonStairs>(m, "StairSegmenter", "Finds stair surfaces.")
      .def(nb::init<>())
      .def(
          "segment_stairs",
          [](StairSegmenter& self, const Observation& obs) {
            return ImageOut<float, ProbabilityOut>(OnOneGrid(
                obs, [&](const Observation& seen) { return Unwrap(self.SegmentStairs(seen)); }));
          },
          nb::sig("def segment_stairs(self, observation: Observation) -> "
                  "numpy.typing.NDArray[typing.Any]"),
          "H x W in [0, 1]: does this pixel show a stair?");
}

void BindEncoder(nb::module_& m) {
  nb::class_<DenseEncoder, PythonEncoder>(m, "DenseEncoder",
                                          "Dense image features and text vectors of one space.")
      .def(nb::init<>())
      .def("dim", &DenseEncoder::Dim, "Numbers per feature.")
      .def("name", &DenseEncoder::Name, "Features of one name mean nothing to another.")
      .def(
          "encode_image",
          [](DenseEncoder& self, const Observation& obs) {
            FeatureGrid grid = OnOneGrid(
                obs, [&](const Observation& seen) { return Unwrap(self.EncodeImage(seen)); });
            return ToArray<GridOut>(std::move(grid.data), {static_cast<std::size_t>(grid.rows),
                                                           static_cast<std::size_t>(grid.cols),
                                                           static_cast<std::size_t>(grid.dim)});
          },
          nb::sig("def encode_image(self, observation: Observation) -> "
                  "numpy.typing.NDArray[typing.Any]"),
          "rows x cols x dim() float32 over the whole image.")
      .def(
          "encode_text",
          [](DenseEncoder& self, const std::string& text) {
            std::vector<float> vector = Unwrap(self.EncodeText(text));
            const std::size_t count = vector.size();
            return ToArray<VectorOut>(std::move(vector), {count});
          },
          nb::sig("def encode_text(self, text: str) -> numpy.typing.NDArray[typing.Any]"),
          "Unit vector (dim(),) float32.");
}

/// Shares a reader that Python does not see.
class PictureLink : public perception::PictureReader {
 public:
  explicit PictureLink(std::shared_ptr<perception::PictureReader> reader)
      : reader_(std::move(reader)) {}
  Result<perception::PictureReading> Read(const perception::GoalPicture& picture) override {
    return reader_->Read(picture);
  }

 private:
  std::shared_ptr<perception::PictureReader> reader_;
};

}  // namespace

PerceptionSuite PerceptionHandle::Suite() const {
  PerceptionSuite suite;
  suite.detector = std::make_unique<DetectorLink>(nb::cast<Detector&>(detector));
  suite.segmenter = std::make_unique<SegmenterLink>(nb::cast<Segmenter&>(segmenter));
  suite.stairs = std::make_unique<StairsLink>(nb::cast<StairSegmenter&>(stairs));
  suite.encoder = std::make_unique<EncoderLink>(nb::cast<DenseEncoder&>(encoder));
  if (pictures) suite.pictures = std::make_unique<PictureLink>(pictures);
  return suite;
}

void BindPerception(nb::module_& m) {
  BindDetection(m);
  BindFinders(m);
  BindEncoder(m);
  nb::class_<PerceptionHandle>(m, "Perception", "The four parts that an agent asks, each frame.")
      .def(
          "__init__",
          [](PerceptionHandle* self, nb::handle_t<Detector> detector,
             nb::handle_t<Segmenter> segmenter, nb::handle_t<StairSegmenter> stairs,
             nb::handle_t<DenseEncoder> encoder) {
            new (self) PerceptionHandle{nb::borrow(detector), nb::borrow(segmenter),
                                        nb::borrow(stairs), nb::borrow(encoder)};
          },
          "detector"_a, "segmenter"_a, "stairs"_a, "encoder"_a)
      .def_prop_ro(
          "detector", [](const PerceptionHandle& p) { return p.detector; },
          nb::sig("def detector(self) -> Detector"))
      .def_prop_ro(
          "segmenter", [](const PerceptionHandle& p) { return p.segmenter; },
          nb::sig("def segmenter(self) -> Segmenter"))
      .def_prop_ro(
          "stairs", [](const PerceptionHandle& p) { return p.stairs; },
          nb::sig("def stairs(self) -> StairSegmenter"))
      .def_prop_ro(
          "encoder", [](const PerceptionHandle& p) { return p.encoder; },
          nb::sig("def encoder(self) -> DenseEncoder"));
}

}  // namespace crossnav::python
