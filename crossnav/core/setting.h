// SPDX-License-Identifier: MIT
// Key and field of a setting as two arguments of a visitor (config_visitor.h), written once, so
// that they cannot differ: visit(CROSSNAV_SETTING(c, bump_m), 0.0, 10.0).
#pragma once

#define CROSSNAV_SETTING(config, name) #name, (config).name
