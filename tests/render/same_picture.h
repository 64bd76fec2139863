// Pictures of the same scene in two representations, and what lit them.
#pragma once

#include <string>
#include <vector>

#include "render/render_frame.h"
#include "same_scene.h"

namespace brisance::testing {

// What lit a picture, as its statistics tell.
struct Mechanism {
    std::vector<std::string> stages;   // of the lighting, in their order
    std::vector<std::string> skipped;  // parts that were left out
    // Of each gathering of light in haze: the spacing of its coarsest lights [m], and the nodes that it lit as a part
    // of all that need light.
    std::vector<float> haze_spacing;
    std::vector<double> haze_nodes;
};

struct LitPicture {
    RenderedFrame frame;
    Mechanism mechanism;
};

LitPicture light(const SameScene& scene);

// Expects of all cells that both pictures show, V, MV and MM at least, less than lighting.error between them, and the
// same mechanism. Prints a line for each cell. `what` names the representation.
void expect_same_picture(const SameScene& scene, const SameScene& other, const std::string& what);
void expect_near_light(const LitPicture& picture, const LitPicture& other, const std::vector<std::string>& cells,
                       double error, const std::string& what);  // whatever lit it
void expect_same_light(const LitPicture& picture, const LitPicture& other, const std::vector<std::string>& cells,
                       double error, const std::string& what);

// `medium` is the one that the frame shows.
Mechanism mechanism_of(const Statistics& statistics, const Medium& medium);

}  // namespace brisance::testing
