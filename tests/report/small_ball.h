// A medium small enough for the path tracer, and a shot of it.
#pragma once

#include "media/node_media.h"
#include "render/input/frame_input.h"
#include "shot/shot.h"

namespace brisance {

inline const FrameInput& input() {
    static const FrameInput ball = [] {
        media::Recipe recipe = media::glowing_ball(5, 2.0f);
        recipe.settings.smoke.albedo = Rgb(0.7f);
        FrameInput made;
        made.medium = media::make_medium(recipe);
        return made;
    }();
    return ball;
}

inline Shot shot() {
    Shot shot;
    shot.volume.file = "ball.vdb";
    shot.method = RenderMethod::Path;
    shot.camera.eye = dvec3(0.0, -6.0, 0.0);
    shot.camera.width = 24;
    shot.camera.height = 18;
    shot.camera_given = true;
    shot.tracing.samples = 16;
    return shot;
}

}  // namespace brisance
