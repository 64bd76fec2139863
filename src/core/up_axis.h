// Files with y up in a world with another axis up.
#pragma once

#include "core/vec.h"

namespace brisance {

// From a file with y up to a world whose axis `up` ('y' or 'z') is what the file's y becomes: (x, y, z) -> (x, -z, y)
// for 'z'. x stays x.
inline dmat4 turned_up(char up) {
    if (up == 'y')
        return dmat4(1.0);
    return {{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}, {0.0, -1.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}};
}

}  // namespace brisance
