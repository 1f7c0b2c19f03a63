// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace resect {

/// scenes/scene.schema.json: the one table of a scene's keys, types, ranges and defaults.
extern const char scene_schema[];

} // namespace resect
