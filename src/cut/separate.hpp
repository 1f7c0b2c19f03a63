// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace resect {

/// Whether a tet is separated. `zero` has a bit for each corner on the sheet, `crossed` one for each of
/// edge_corners that the blade crossed. Corners off the sheet that uncrossed edges join are on one side: the
/// answer is a mask of the corners on the side of the lowest such corner, or 0 if that is all of them.
unsigned find_side(unsigned zero, unsigned crossed);

} // namespace resect
