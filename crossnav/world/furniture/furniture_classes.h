// SPDX-License-Identifier: MIT
// Which models of the Sweet Home 3D furniture libraries stand for which kind of MakeFurniture:
// chosen by hand from the catalogues, ambiguous pieces (day beds, high chairs) left out. Facts
// only; the models themselves stay in their package.
#pragma once

#include <span>
#include <string_view>

namespace crossnav::world {

struct FurnitureClass {
  std::string_view id;    ///< catalogue id, unique over all libraries
  std::string_view kind;  ///< of MakeFurniture
};

std::span<const FurnitureClass> FurnitureClasses();

/// Models in the CC0 library whose own licence file says CC-BY.
bool IsReallyCcBy(std::string_view id);

/// Triangles that a model of `kind` may keep.
int TriangleBudget(std::string_view kind);

}  // namespace crossnav::world
