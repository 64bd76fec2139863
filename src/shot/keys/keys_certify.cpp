#include "shot/keys/keys.h"

namespace brisance {

void add_correction_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "correction.samples",
        "unbiased samples, each a ray of the camera with its paths, that tell what a picture by many lights misses; it "
        "is blurred as much as their noise demands and put back; 0: none; auto: as many as the picture "
        "needs to reach lighting.error, in up to 2 times its time at 0.02 and 12 times at 0.01; none from 0.04 on",
        or_word(whole(0, 1 << 28), "auto", kAutomaticCorrection),
        [](Shot & s) -> auto& { return s.correction.samples; }));
}

void add_certify_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "certify.enabled", "estimates each finished frame's error against the truth, as --certify does", flag(),
        [](Shot & s) -> auto& { return s.certify.enabled; }));
    keys.push_back(make_key(
        "certify.samples",
        "unbiased samples, each a ray of the camera with its paths, that a certificate may cost in all",
        whole(1024, 1 << 30), [](Shot & s) -> auto& { return s.certify.samples; }));
    keys.push_back(make_key(
        "certify.seed", "other seeds give certificates from other samples", whole(0, 1 << 30),
        [](Shot & s) -> auto& { return s.certify.seed; }));
    keys.push_back(make_key(
        "certify.belief",
        "share of a frame's forecast time that unbiased samples for its believed error may cost; 0: it is believed "
        "without samples, from the error model alone",
        real({0.0, 1.0}), [](Shot & s) -> auto& { return s.certify.belief; }));
}

}  // namespace brisance
