#include "light_selection/progressive_radius.h"

#include <cmath>

namespace brisance {

double radius_shrunk(int pass, double alpha, int blurred_dimensions) {
    double power = 1.0;
    for (int i = 1; i <= pass; ++i)
        power *= (i + alpha) / (i + 1.0);
    return std::pow(power, 1.0 / blurred_dimensions);
}

double fastest_alpha(int blurred_dimensions) {
    return 4.0 / (4.0 + blurred_dimensions);
}

}  // namespace brisance
