// SPDX-License-Identifier: MIT
// Binary glTF 2.0 out of a scene: the rendered mesh and the semantic mesh of HM3D's layout. Inside
// the file x_f = -y_world, y_f = x_world, z_f = z_world (z up, as HM3D's files). Deterministic: the
// same scene gives the same bytes.
#pragma once

#include <cstdint>
#include <string>

#include "crossnav/core/image.h"
#include "crossnav/sim/scene/scene.h"

namespace crossnav::world {

/// Numbers of colour factors and vertex colours: linear light, as glTF defines them, or the
/// picture's own (sRGB / 255) for renderers that multiply them with a texture's bytes as they are,
/// as habitat-sim does.
enum class RenderColours { kLinear, kAsShown };

/// One primitive per material, textures embedded as PNG, vertex colours if the scene has them.
std::string EncodeRenderGlb(const sim::Scene& scene,
                            RenderColours colours = RenderColours::kLinear);

/// Encoding of instances in vertex colours: as bytes, which renderers take for linear light, or as
/// 16-bit linear light, which every renderer converts to the bytes of the semantic text.
enum class SemanticColours { kBytes, kLinear };

/// One unlit primitive with instances as vertex colours (SemanticColour of the id).
std::string EncodeSemanticGlb(const sim::Scene& scene,
                              SemanticColours colours = SemanticColours::kBytes);

/// Colour of an instance in the semantic mesh and text; different ids below 2^24 differ.
Rgb8 SemanticColour(int instance_id);

}  // namespace crossnav::world
