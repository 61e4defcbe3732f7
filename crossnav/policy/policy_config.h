// SPDX-License-Identifier: MIT
// Settings of candidates, modes, stairs and approach. Defaults: tab:supp_configuration; a value the
// paper does not have says "chosen".
#pragma once

#include <string>

#include "crossnav/core/setting.h"
#include "crossnav/policy/onemap_config.h"

namespace crossnav::policy {

struct ObjectConfig {
  double detector_confidence = 0.70;
  double secondary_confidence = 0.60;
  double found_confidence = 0.70;
  double min_box_area_fraction = 1.0 / 64;
  int min_projected_voxels = 10;
  int stable_frames = 2;          // chosen: two agreeing frames
  double merge_distance_m = 0.5;  // chosen: centres of one object seen from two sides
};

struct PoiConfig {
  bool use_history = true;     ///< false = the paper's "w/o H-POI"
  bool keep_coverage = false;  ///< use_history = false: inspected ground stays inspected at a new
                               ///< goal; profile full only
  double similarity_slack = 0.08;  // chosen: below the similarity of confirmed objects; full only
  double live_takeover_m = 1.0;
  double blacklist_xy_m = 0.8, blacklist_z_m = 0.6;
};

struct FrontierConfig {
  int min_cluster = 5;
  int min_cluster_init_descent = 2;
  double level_band_m = 0.35;     // chosen: one step above the maximum climb
  double unknown_column_m = 0.3;  // chosen: genuine unknown, nothing seen within +-0.3 m
  double arrival_m = 0.35;        // chosen: one forward step and a voxel
  int grace_steps = 20;           // chosen: path of a few metres; profile paper only
};

struct StairConfig {
  double pixel_threshold = 0.25;
  int min_component_px = 80;
  double descent_confirmation = 0.48;
  double geometry_threshold = 0.65;
  double admission_radius_m = 2.5;
  double arrival_m = 0.40;
  int landing_frames = 3;       // chosen: multi-frame landing confirmation
  int evidence_window = 10;     // chosen: of the last ten frames ...
  int evidence_frames = 3;      // chosen: ... three must show the stairs
  int min_progress_steps = 60;  // chosen: a session without vertical progress ends
};

struct ApproachConfig {
  double range_m = 1.30;
  double stray_share = 0.15;       // chosen: of profile full; nearest voxels that do not count
                                   // for a distance: noise, and a table in a sofa's mask
  double min_visibility = 0.3;     // chosen: share of the object's voxels in line of sight
  double min_mask_quality = 0.5;   // chosen
  double max_view_angle_deg = 35;  // chosen: object within the middle of the image
  int max_viewpoints = 4;          // chosen: tries before the blacklist
};

/// Walking: how the body keeps clear, and how far ahead steps are searched.
struct MotionConfig {
  double wanted_clearance_m = 0.10;  // chosen: the body's radius
  double min_clearance_m = 0.02;     // chosen: occupied voxels are up to a voxel wider
  double clearance_weight = 4;       // chosen: [steps] extra cost of a step that touches
  double turn_steps = 0.4;           // chosen: [steps] price of a turn, which adds no path
  double arrival_m = 0.12;           // chosen: half a forward step
  double min_gain_steps = 0.3;       // chosen: less is not worth a turn
  int horizon_steps = 8;             // chosen: two metres
  double travel_pitch_deg = -30;     // chosen: sees the ground at the feet and the horizon
  double bump_m = 0.20;              // chosen: a forward step that moved less met something
};

/// Exploration of policy.profile = full. Settings named _m without another noun are prices: metres
/// that a property of a candidate adds to its path.
struct ExploreConfig {
  std::string scoring = "area";  ///< nearest | area | semantic (docs/navigation.md, "Frontiers")
  int min_cluster = 4;           // chosen: columns; a smaller gap does not let the body through
  double other_floor_penalty_m = 12;     // chosen: length of a flight and its approach
  double small_frontier_penalty_m = 40;  // chosen: frontiers under min_cluster come last
  double room_m2 = 8;                    // chosen: unseen area at which a frontier has weight 1
  double least_share = 0.1;              // chosen: minimum frontier weight, as a fraction
  double start_m = 1;                    // chosen: fixed price of setting out
  double hint_confidence = 0.4;  // chosen: minimum confidence of a hint, at any size in the image
  double hint_bonus_m = -8;      // chosen: price of a hint; negative, so that it beats a frontier
  double uninspected_m = 10;     // chosen: ground seen from too far for the detector
  double turn_back_m = 20;       // chosen: candidates behind the agent on a flight
  double doubt_m = 5;            // chosen: for each frontier nearby that did not open
  double doubt_range_m = 3;      // chosen: a few widths of a door
  double commit_m = 2;           // chosen: hysteresis in favour of the current target
  double inspect_range_m = 5;    // chosen: range at which a detector answers for a chair
  double view_range_m = 4.0;     // chosen: depth of the unseen area counted behind a frontier
  int min_uninspected = 8;       // chosen: columns of 25 around
  int relevancy_steps = 12;      // chosen: interval of memory queries, scoring = semantic
  int reconsider_steps = 6;      // chosen: the grace period of a commitment
  int progress_steps = 24;       // chosen: a turn around, twice
  int max_choices = 6;           // chosen: limit of choices of a target that is never reached
  double same_place_m = 0.5;     // chosen: half the width of a door
  double glance_m2 = 0.5;        // chosen: unseen area that is worth a turn to the side
  double glance_range_m = 9;     // chosen: depth of that area
  double floor_prior_m_per_bit = 25;  // chosen: path worth a doubling of a floor's odds
  double furniture_m = 1.1;  // chosen: height limit of furniture that is climbed by mistake
  double storey_m = 1.8;     // chosen: more than a landing, less than a floor
};

struct PolicyConfig {
  std::string profile = "full";  ///< full | paper (the literal method) | onemap (the baseline)
  MotionConfig motion;
  ExploreConfig explore;
  ObjectConfig object;
  PoiConfig poi;
  FrontierConfig frontier;
  StairConfig stair;
  ApproachConfig approach;
  OneMapConfig onemap;
  bool planar = false;  ///< variant: no stairs, one level, the planar persistent-memory stand-in
};

template <class V>
void Visit(V& visit, ObjectConfig& c) {
  visit(CROSSNAV_SETTING(c, detector_confidence), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, secondary_confidence), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, found_confidence), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, min_box_area_fraction), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, min_projected_voxels), 1, 100000);
  visit(CROSSNAV_SETTING(c, stable_frames), 1, 1000);
  visit(CROSSNAV_SETTING(c, merge_distance_m), 0.0, 10.0);
}
template <class V>
void Visit(V& visit, PoiConfig& c) {
  visit(CROSSNAV_SETTING(c, use_history));
  visit(CROSSNAV_SETTING(c, keep_coverage));
  visit(CROSSNAV_SETTING(c, similarity_slack), 0.0, 2.0);
  visit(CROSSNAV_SETTING(c, live_takeover_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, blacklist_xy_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, blacklist_z_m), 0.0, 100.0);
}
template <class V>
void Visit(V& visit, FrontierConfig& c) {
  visit(CROSSNAV_SETTING(c, min_cluster), 1, 100000);
  visit(CROSSNAV_SETTING(c, min_cluster_init_descent), 1, 100000);
  visit(CROSSNAV_SETTING(c, level_band_m), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, unknown_column_m), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, arrival_m), 0.05, 10.0);
  visit(CROSSNAV_SETTING(c, grace_steps), 0, 100000);
}
template <class V>
void Visit(V& visit, StairConfig& c) {
  visit(CROSSNAV_SETTING(c, pixel_threshold), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, min_component_px), 1, 1000000);
  visit(CROSSNAV_SETTING(c, descent_confirmation), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, geometry_threshold), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, admission_radius_m), 0.1, 100.0);
  visit(CROSSNAV_SETTING(c, arrival_m), 0.05, 10.0);
  visit(CROSSNAV_SETTING(c, landing_frames), 1, 1000);
  visit(CROSSNAV_SETTING(c, evidence_window), 1, 1000);
  visit(CROSSNAV_SETTING(c, evidence_frames), 1, 1000);
  visit(CROSSNAV_SETTING(c, min_progress_steps), 1, 100000);
}
template <class V>
void Visit(V& visit, ApproachConfig& c) {
  visit(CROSSNAV_SETTING(c, range_m), 0.1, 10.0);
  visit(CROSSNAV_SETTING(c, stray_share), 0.0, 0.9);
  visit(CROSSNAV_SETTING(c, min_visibility), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, min_mask_quality), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, max_view_angle_deg), 1.0, 90.0);
  visit(CROSSNAV_SETTING(c, max_viewpoints), 1, 1000);
}
template <class V>
void Visit(V& visit, MotionConfig& c) {
  visit(CROSSNAV_SETTING(c, wanted_clearance_m), 0.01, 1.0);
  visit(CROSSNAV_SETTING(c, min_clearance_m), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, clearance_weight), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, arrival_m), 0.01, 10.0);
  visit(CROSSNAV_SETTING(c, turn_steps), 0.01, 100.0);
  visit(CROSSNAV_SETTING(c, min_gain_steps), 0.0, 10.0);
  visit(CROSSNAV_SETTING(c, horizon_steps), 1, 40);
  visit(CROSSNAV_SETTING(c, travel_pitch_deg), -90.0, 90.0);
  visit(CROSSNAV_SETTING(c, bump_m), 0.0, 10.0);
}
template <class V>
void Visit(V& visit, ExploreConfig& c) {
  visit(CROSSNAV_SETTING(c, scoring), {"nearest", "area", "semantic"});
  visit(CROSSNAV_SETTING(c, min_cluster), 1, 100000);
  visit(CROSSNAV_SETTING(c, other_floor_penalty_m), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, small_frontier_penalty_m), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, room_m2), 0.01, 10000.0);
  visit(CROSSNAV_SETTING(c, least_share), 0.001, 1.0);
  visit(CROSSNAV_SETTING(c, start_m), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, hint_confidence), 0.0, 1.0);
  visit(CROSSNAV_SETTING(c, hint_bonus_m), -100000.0, 100000.0);
  visit(CROSSNAV_SETTING(c, uninspected_m), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, turn_back_m), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, doubt_m), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, doubt_range_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, commit_m), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, inspect_range_m), 0.1, 100.0);
  visit(CROSSNAV_SETTING(c, view_range_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, min_uninspected), 1, 25);
  visit(CROSSNAV_SETTING(c, relevancy_steps), 1, 100000);
  visit(CROSSNAV_SETTING(c, reconsider_steps), 1, 100000);
  visit(CROSSNAV_SETTING(c, progress_steps), 1, 100000);
  visit(CROSSNAV_SETTING(c, max_choices), 1, 100000);
  visit(CROSSNAV_SETTING(c, same_place_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, glance_m2), 0.0, 100000.0);
  visit(CROSSNAV_SETTING(c, glance_range_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, floor_prior_m_per_bit), 0.0, 1000.0);
  visit(CROSSNAV_SETTING(c, furniture_m), 0.0, 100.0);
  visit(CROSSNAV_SETTING(c, storey_m), 0.1, 100.0);
}
template <class V>
void Visit(V& visit, PolicyConfig& c) {
  visit.Section("motion", c.motion);
  visit.Section("explore", c.explore);
  visit.Section("object", c.object);
  visit.Section("poi", c.poi);
  visit.Section("frontier", c.frontier);
  visit.Section("stair", c.stair);
  visit.Section("approach", c.approach);
  visit.Section("onemap", c.onemap);
  visit(CROSSNAV_SETTING(c, profile), {"full", "paper", "onemap"});
  visit(CROSSNAV_SETTING(c, planar));
}

}  // namespace crossnav::policy
