// SPDX-License-Identifier: MIT
// Paths of this checkout. Only the generated places.cpp contains them, so that the objects of tests
// are equal in all checkouts and the compiler cache of one serves the other.
#pragma once

#include <string>

namespace crossnav::test {

/// A file or folder of the checkout, by its path from the root.
std::string SourcePath(const std::string& file);
/// The same in `shared`, data beside the checkout; tests that need absent data are skipped.
std::string SharedPath(const std::string& file);
/// The program crossnav; empty in a build without it.
std::string ProgramPath();

}  // namespace crossnav::test
