// SPDX-License-Identifier: MIT
// Maps models of the Sweet Home 3D furniture libraries to kinds of MakeFurniture: chosen by hand
// from the catalogues, without ambiguous pieces (day beds, high chairs). Facts only; the models
// themselves stay in their package.
#pragma once

#include <span>
#include <string_view>

namespace crossnav::world {

struct FurnitureClass {
  std::string_view id;    ///< catalogue id, unique over all libraries
  std::string_view kind;  ///< of MakeFurniture
};

std::span<const FurnitureClass> FurnitureClasses();

/// Models in the CC0 library with a licence file of CC-BY.
bool IsReallyCcBy(std::string_view id);

/// Maximum number of triangles of a model of `kind`.
int TriangleBudget(std::string_view kind);

}  // namespace crossnav::world
