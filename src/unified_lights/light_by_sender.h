// Light that a surface or smoke scatters, by what sent it there: a cell of the ledger each.
#pragma once

#include "core/vec.h"

namespace brisance {

struct LightBySender {
    Rgb surfaces{0.0f}, fire{0.0f}, emitters{0.0f};  // SS, SV, SA; MS, MV, MA [W/(m^2 sr)]

    LightBySender() = default;
    explicit LightBySender(const Rgb& of_each) : surfaces(of_each), fire(of_each), emitters(of_each) {}

    LightBySender& operator+=(const LightBySender& other) {
        surfaces += other.surfaces;
        fire += other.fire;
        emitters += other.emitters;
        return *this;
    }
    friend LightBySender operator*(LightBySender a, float factor) {
        a.surfaces *= factor;
        a.fire *= factor;
        a.emitters *= factor;
        return a;
    }
    friend LightBySender operator*(const Rgb& factor, LightBySender a) {
        a.surfaces *= factor;
        a.fire *= factor;
        a.emitters *= factor;
        return a;
    }
    // Of all together: the sum that an error is a part of.
    friend float luminance(const LightBySender& a) { return luminance(a.surfaces + a.fire + a.emitters); }
};

}  // namespace brisance
