#include <gtest/gtest.h>

#include "camera_rays/moment_mean.h"

namespace brisance {
namespace {

Image picture(float radiance, float alpha, float z) {
    Image image;
    image.width = image.height = 1;
    image.layers.push_back({"", {"R", "G", "B", "A"}, false, {radiance, radiance, radiance, alpha}});
    image.layers.push_back({"Z", {"Z"}, true, {z}});
    return image;
}

constexpr float kNothing = 1e10f;

TEST(MomentMean, LightAndOpacityAreAveraged) {
    MomentMean mean;
    mean.add(picture(1.0f, 1.0f, 4.0f));
    mean.add(picture(3.0f, 0.5f, 4.0f));
    const Image out = mean.take();
    EXPECT_EQ(out.layer("").pixels, (std::vector<float>{2.0f, 2.0f, 2.0f, 0.75f}));
}

TEST(MomentMean, DepthIsThatOfWhatIsSeen) {
    MomentMean mean;
    mean.add(picture(1.0f, 0.75f, 4.0f));
    mean.add(picture(0.0f, 0.0f, kNothing));
    mean.add(picture(1.0f, 0.25f, 8.0f));
    EXPECT_FLOAT_EQ(mean.take().layer("Z").pixels[0], 5.0f);
}

TEST(MomentMean, WhereNothingIsSeenDepthStaysSo) {
    MomentMean mean;
    mean.add(picture(0.0f, 0.0f, kNothing));
    mean.add(picture(0.0f, 0.0f, kNothing));
    EXPECT_FLOAT_EQ(mean.take().layer("Z").pixels[0], kNothing);
}

}  // namespace
}  // namespace brisance
