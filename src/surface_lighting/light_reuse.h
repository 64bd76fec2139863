// Camera samples reuse the virtual lights that others around them chose by resampling: spatial reuse within a picture.
//
// [1] B. Bitterli et al., Spatiotemporal Reservoir Resampling for Real-Time Ray Tracing with Dynamic Direct Lighting,
//     SIGGRAPH 2020, section 4 and algorithm 6.
// [2] D. Lin et al., Generalized Resampled Importance Sampling: Foundations of ReSTIR, ACM Transactions on Graphics
//     41(4), 2022, sections 4 and 5.
//
// A sample i has a target t_i, its light without occlusion, and has chosen y_i with the weight W_i, such that
// E[W_i g(y_i)] is the integral of g over all y with t_i(y) > 0 (light_reservoir.h). The set S of a sample x are x
// itself and some neighbours. One of their choices is resampled by
//
//     w_i = m_i(y_i) t_x(y_i) W_i,    m_i(y) = t_i(y) / sum over j in S of t_j(y)
//     y = y_i with probability w_i / sum w,    W = (sum w) / t_x(y),    estimate = F_x(y) W
//
// The mean is sum over i of E[m_i(y_i) F_x(y_i) W_i] = sum over i of the integral of m_i F_x, taken where t_i > 0.
// There the m_i of all i sum to 1 wherever any t_i > 0, t_x among them, and F_x is 0 where t_x is: it is the integral
// of F_x, whichever neighbours S has, as long as no choice of light decided that. F_x is evaluated once, with the exact
// visibility and transmittance of x. Visibility is in no target so far, and no ray is needed to tell which neighbour
// could have chosen y.
//
// With visibility, a sample that does not see what it chose gives it away to nobody: its target is t_i V_i. Telling who
// could have chosen y takes rays then. Of k neighbours, each is paired with x alone ([2], section 5.4):
//
//     m_i(y) = 1/k a_i / (a_i + b),    m_x(y) = 1/k sum over i of b / (a_i + b),    a_i = t_i V_i, b = t_x / k
//
// V_i(y_i) is 1, and takes no ray. m_x enters the estimate linearly, so that one term of its sum, of a random i, keeps
// the mean: three rays for a sample, however many neighbours it has.
//
// Rounds repeat that with other neighbours, among what the round before has kept ([1], algorithm 5). For any g that is
// 0 where t_x is, E[W g(y)] = sum over i of E[m_i(y_i) g(y_i) W_i], which is the integral of g: what a sample keeps is
// such a choice again, whether or not the choices that it came from have some in common. With visibility it has to
// reach the sample before it is given away, which takes a ray in every round but the last. A choice stands for as many
// first choices as it was taken from: that count C, the M of [1], follows from the sets alone and multiplies t in all
// weights.
//
// Departs from [1]: no reuse from frame to frame, frames stay independent; the generalized balance heuristic of [2]
// instead of the weights 1/Z of algorithm 6, which divides by the number of neighbours that could have chosen y, and is
// noisy where their targets differ.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pixel_sharing/shared_bounce.h"
#include "surface_lighting/bound_account.h"
#include "virtual_lights/gatherers/light_reservoir.h"
#include "virtual_lights/gatherers/reservoir.h"

namespace brisance {

class LightReuse {
public:
    // What a sample of the camera sees by some lobes, and what these chose.
    struct Sample {
        std::uint32_t pixel = 0;
        std::uint64_t number = 0;  // of the sample in its pixel
        PathVertex vertex;
        LightReservoir reservoir;
        Lobes lobes = Lobes::All;
        int material = 0;
        double from_eye = 0.0;  // [m]
        float share = 1.0f;     // of the light, what the pixel shows
        // Where all pixels share light: it goes there, over the lobes' colour. It holds the sample's other light.
        std::optional<SharedBounce::Sample> shared = std::nullopt;
        Rgb colour{1.0f};
    };

    struct Settings {
        int neighbours;           // of each sample, at most
        double radius;            // in which they lie [pixels]; 0: in the same pixel
        bool visibility = false;  // what samples chose reaches them
        int rounds = 1;           // of reuse, in which neighbours are drawn anew
        std::uint32_t seed = 0;   // other seeds draw other random numbers
    };

    // Keeps references. `shared`: gets the light of samples that have something to share; null where none has.
    // `bound`: gets what the bound of point lights takes of what is reused; null: nobody asks.
    LightReuse(const ReservoirLights& lights, int width, int height, const Settings& settings, SharedBounce* shared,
               BoundAccount* bound = nullptr);

    // That a picture takes whose samples all have lights to reuse, about. `rows_at_once`: of a call of add(); `rays`:
    // of a pixel, each with two samples where lobes are lit apart.
    static std::uint64_t bytes_of(int width, int height, int rays, int rows_at_once, const Settings& settings);

    // Samples of whole rows, in the order of rows. Not thread-safe. Rows whose neighbours are all known are lit, and
    // their samples forgotten: those of (rounds + 1) radius + 1 rows are kept, beside the rows of one call.
    void add(std::vector<Sample> samples);

    // Light of each pixel [W/(m^2 sr)], but for what is shared. Uses up the samples.
    std::vector<Rgb> take_pixels();

private:
    struct Found {
        BoundedLight light;
        double seconds = 0.0;  // processor time, where somebody asks
    };
    // What a sample has kept after some rounds.
    struct Choice {
        LightReservoir reservoir;
        double count = 1.0;  // of the first choices that it was taken from
    };
    struct Row {
        std::vector<Sample> samples;
        std::vector<std::uint32_t> first;  // sample of each pixel, and an end
        // Of each sample: round r reads those of r % 2 and writes the others, which no round reads any more.
        std::vector<Choice> choices[2];
    };
    // A sample in a round, with what it chose before.
    struct Member {
        const Sample* sample;
        const Choice* choice;
    };
    using Set = std::vector<Member>;  // the first reuses what all chose

    void advance(int added);
    void prepare_rows(int begin, int end);
    void exchange_rows(int round, int begin, int end);
    void light_rows(int begin, int end);
    Set set_of(int round, int y, std::size_t number, Rng& rng) const;
    std::optional<Member> choose_around(int round, const Sample& sample, Rng& rng) const;
    Rng rng_of(int round, const Sample& sample) const;
    // What is kept has 1 / t_x(y) for its weight.
    void offer_unoccluded(const Set& set, Reservoir<LightReservoir>& kept, Rng& rng) const;
    void offer_visible(const Set& set, Reservoir<LightReservoir>& kept, Rng& rng) const;
    LightReservoir resample(const Set& set, Rng& rng) const;
    Choice exchange(int round, int y, std::size_t number) const;
    BoundedLight light(int y, std::size_t number) const;
    void show(Sample& sample, const Found& found);

    const ReservoirLights& lights_;
    int width_, height_;
    Settings settings_;
    int reach_;  // [rows]
    SharedBounce* shared_;
    BoundAccount* bound_;
    std::vector<Row> rows_;
    std::vector<int> done_;  // rows, of each round
    std::vector<Rgb> pixels_;
};

}  // namespace brisance
