// SPDX-License-Identifier: MIT
// Bounds-checked view of one glTF accessor. Private to the glTF reader (pulls in tinygltf).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include <tiny_gltf.h>

#include "crossnav/core/result.h"

namespace crossnav::sim {

/// `count` elements of `components` numbers; every byte was checked to lie inside the buffer.
struct AccessorView {
  const std::uint8_t* data = nullptr;
  std::size_t stride = 0;  // [bytes]
  std::size_t count = 0;
  int components = 0;
  int component_type = 0;  // TINYGLTF_COMPONENT_TYPE_*
  bool normalized = false;

  template <class T>
  T Read(std::size_t element, int component) const {
    T value;
    std::memcpy(&value, data + element * stride + sizeof(T) * static_cast<std::size_t>(component),
                sizeof(T));
    return value;
  }

  /// The number as glTF means it: integers are scaled to [0, 1] or [-1, 1] where normalised.
  float Float(std::size_t element, int component) const {
    const auto scaled = [this](float value, float top) {
      return normalized ? std::max(value / top, -1.0F) : value;
    };
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return Read<float>(element, component);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return scaled(Read<std::uint8_t>(element, component), 255.0F);
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return scaled(Read<std::int8_t>(element, component), 127.0F);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return scaled(Read<std::uint16_t>(element, component), 65535.0F);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return scaled(Read<std::int16_t>(element, component), 32767.0F);
      default:
        return static_cast<float>(Read<std::uint32_t>(element, component));
    }
  }

  /// Of an index accessor (unsigned 8, 16 or 32 bits).
  std::uint32_t Index(std::size_t element) const {
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return Read<std::uint8_t>(element, 0);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return Read<std::uint16_t>(element, 0);
      default:
        return Read<std::uint32_t>(element, 0);
    }
  }
};

/// Accessor `index` of `model`; an Error (at `where`, accessor n) where anything is out of range.
inline Result<AccessorView> ViewAccessor(const tinygltf::Model& model, int index,
                                         const std::string& where) {
  const std::string at = where + ": accessor " + std::to_string(index);
  const auto bad = [&at](const char* what) { return Fail(ErrorCode::kMalformed, what, at); };
  if (index < 0 || index >= static_cast<int>(model.accessors.size())) return bad("does not exist");
  const tinygltf::Accessor& a = model.accessors[static_cast<std::size_t>(index)];
  if (a.sparse.isSparse) return Fail(ErrorCode::kUnsupported, "sparse accessors are not read", at);
  if (a.bufferView < 0 || a.bufferView >= static_cast<int>(model.bufferViews.size())) {
    return bad("has no buffer view");
  }
  const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
  if (view.buffer < 0 || view.buffer >= static_cast<int>(model.buffers.size())) {
    return bad("its buffer does not exist");
  }
  const auto& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  const int component_bytes =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType));
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type));
  if (component_bytes <= 0 || component_bytes > 4 || components <= 0 || components > 4) {
    return bad("has a type that meshes do not use");
  }
  const std::size_t element = static_cast<std::size_t>(component_bytes) * components;
  const std::size_t stride = view.byteStride == 0 ? element : view.byteStride;
  if (stride < element || stride > 255) return bad("has an impossible stride");
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    return bad("its buffer view reaches beyond the buffer (file truncated?)");
  }
  // count * stride cannot overflow below: count is at most the number of bytes there are.
  if (a.count > view.byteLength || a.byteOffset > view.byteLength) {
    return bad("reaches beyond its buffer view");
  }
  if (a.count > 0 && a.byteOffset + stride * (a.count - 1) + element > view.byteLength) {
    return bad("reaches beyond its buffer view");
  }
  return AccessorView{bytes.data() + view.byteOffset + a.byteOffset,
                      stride,
                      a.count,
                      components,
                      a.componentType,
                      a.normalized};
}

}  // namespace crossnav::sim
