// Codecs of what a shot says of time and velocity.
#pragma once

#include "codec/codec.h"
#include "retiming/settings.h"
#include "time_mapping/settings.h"

namespace brisance {

Codec<BeyondEnd> beyond_end();
Codec<MissingFrame> missing_frame();
Codec<Retime> retime();
Codec<VelocityUnit> velocity_unit();
Codec<std::vector<TimePoint>> time_curve();  // [[frame, source time], ...], frames rising, times not falling

Range source_times();  // whole frame numbers fit into 32 bits
Range speeds();
Range frame_rates();

Codec<std::optional<std::vector<std::string>>> velocity_grids();  // a name, three names, "" for none, null

// As objects, for further volumes.
Codec<TimeSettings> time_object();
Codec<VelocitySettings> velocity_object();

}  // namespace brisance
