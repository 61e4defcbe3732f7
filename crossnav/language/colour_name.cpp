// SPDX-License-Identifier: MIT
#include "crossnav/language/colour_name.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crossnav::language {
namespace {

/// CIE L*a*b*, D65.
struct Lab {
  double l = 0, a = 0, b = 0;
};

double Linear(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double CubeRoot(double t) {
  return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0;
}

Lab LabOf(const Rgb8& rgb) {
  const double r = Linear(rgb.r / 255.0), g = Linear(rgb.g / 255.0), b = Linear(rgb.b / 255.0);
  const double x = CubeRoot((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
  const double y = CubeRoot(0.2126 * r + 0.7152 * g + 0.0722 * b);
  const double z = CubeRoot((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

struct Prototype {
  Colour colour;
  Rgb8 rgb;
};

// chosen: prototypes of each name, light and dark; several for names of many shades.
constexpr std::array<Prototype, 34> kPrototypes = {{
    {Colour::kBlack, {15, 15, 15}},    {Colour::kBlack, {40, 40, 42}},
    {Colour::kGrey, {95, 95, 98}},     {Colour::kGrey, {130, 130, 130}},
    {Colour::kGrey, {165, 165, 168}},  {Colour::kWhite, {215, 215, 212}},
    {Colour::kWhite, {250, 250, 250}}, {Colour::kBeige, {200, 185, 155}},
    {Colour::kBeige, {225, 210, 180}}, {Colour::kBrown, {85, 60, 40}},
    {Colour::kBrown, {120, 85, 55}},   {Colour::kBrown, {155, 115, 75}},
    {Colour::kRed, {110, 30, 30}},     {Colour::kRed, {170, 45, 40}},
    {Colour::kRed, {220, 40, 40}},     {Colour::kOrange, {200, 110, 40}},
    {Colour::kOrange, {240, 140, 40}}, {Colour::kYellow, {200, 180, 60}},
    {Colour::kYellow, {245, 220, 70}}, {Colour::kGreen, {40, 70, 40}},
    {Colour::kGreen, {60, 110, 60}},   {Colour::kGreen, {90, 150, 80}},
    {Colour::kGreen, {115, 130, 95}},  {Colour::kGreen, {110, 200, 110}},
    {Colour::kBlue, {35, 50, 90}},     {Colour::kBlue, {50, 80, 150}},
    {Colour::kBlue, {80, 130, 200}},   {Colour::kBlue, {95, 115, 145}},
    {Colour::kBlue, {60, 130, 140}},   {Colour::kPurple, {80, 45, 95}},
    {Colour::kPurple, {130, 80, 150}}, {Colour::kPurple, {170, 130, 190}},
    {Colour::kPink, {220, 130, 150}},  {Colour::kPink, {245, 180, 195}},
}};

constexpr double kShade = 0.76;       // chosen: seen over true colour, objects of house 301
constexpr double kLightWeight = 0.6;  // chosen: lamps change lightness more than hue
constexpr double kClose = 14;         // chosen: excess over the distance to the nearest name

/// Distance of the nearest prototype of each name.
std::array<double, kColours> Distances(const Rgb8& rgb) {
  std::array<double, kColours> distances;
  distances.fill(1e9);
  const Lab lab = LabOf(rgb);
  for (const Prototype& prototype : kPrototypes) {
    const Lab other = LabOf(prototype.rgb);
    const double l = kLightWeight * (lab.l - other.l);
    double& least = distances[static_cast<int>(prototype.colour)];
    least = std::min(least, std::hypot(l, lab.a - other.a, lab.b - other.b));
  }
  return distances;
}

}  // namespace

std::string_view NameOf(Colour colour) {
  constexpr std::string_view kNames[kColours] = {"black", "grey", "white",  "beige",
                                                 "brown", "red",  "orange", "yellow",
                                                 "green", "blue", "purple", "pink"};
  return kNames[static_cast<int>(colour)];
}

Rgb8 SurfaceColourOf(const Rgb8& seen) {
  const auto lit = [](std::uint8_t s) {
    return static_cast<std::uint8_t>(std::min(255.0, s / kShade + 0.5));
  };
  return {lit(seen.r), lit(seen.g), lit(seen.b)};
}

Colour NameColour(const Rgb8& rgb) {
  const auto distances = Distances(rgb);
  return static_cast<Colour>(std::min_element(distances.begin(), distances.end()) -
                             distances.begin());
}

Fit FitOf(Colour colour, const Rgb8& rgb) {
  const auto distances = Distances(rgb);
  const double least = *std::min_element(distances.begin(), distances.end());
  const double own = distances[static_cast<int>(colour)];
  if (own <= least) return Fit::kYes;
  return own <= least + kClose ? Fit::kMaybe : Fit::kNo;
}

}  // namespace crossnav::language
