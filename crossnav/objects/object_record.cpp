// SPDX-License-Identifier: MIT
#include "crossnav/objects/object_record.h"
