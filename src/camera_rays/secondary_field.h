// The medium as rays from surfaces see it: its emission, and what it scatters, each as one colour.
//
// Such rays come in no order, and each is one of many samples: they cost mainly what they read. A node takes 32 bytes
// here instead of up to 72 (source_field.h), for cells are not told apart but for the fire's own light, and a voxel one
// or two samples instead of up to eight.
#pragma once

#include <array>

#include "camera_rays/source_field.h"
#include "core/ray.h"

namespace brisance {

class SecondaryField {
public:
    // Keeps a reference. The field must know no similar medium: its rays have two depths.
    explicit SecondaryField(const SourceField& field);

    struct Seen {
        Rgb emission{0.0f}, scattered{0.0f};  // [W/(m^2 sr)]; light from emitters as far as the field holds it
        float transmittance = 1.0f;
        float closeness = 0.0f;  // the mean of 1 / distance, where the medium hides what is behind, of that share [1/m]
    };
    // Along a ray up to `end` metres. Extinction is constant over a voxel, that of its middle; sources are those of the
    // mean depth from which light leaves it, so that sources which change linearly along it are exact.
    Seen along(const Ray& ray, double end) const;

private:
    using Records = std::array<SecondaryRecord, SourceField::kRecords>;
    const Records& records(std::size_t brick) const;

    const SourceField& field_;
    dmat3 index_from_local_;
    MadeWhenAsked<Records> made_;
};

}  // namespace brisance
