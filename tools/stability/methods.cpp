#include "stability/methods.h"

#include <algorithm>

#include "core/error.h"
#include "shot/keys/keys.h"

namespace brisance::stability {

namespace {

// Particles are followed until they are absorbed: fewer than by default, as cases are small and there are many.
constexpr int kPaths = 65536;

const Key* find_key(const std::string& path) {
    const std::vector<Key>& keys = shot_keys();
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.path == path; });
    return found == keys.end() ? nullptr : &*found;
}

void set(Shot& shot, const std::string& path, int value) {
    const Key* const key = find_key(path);
    if (!key || !key->set(shot, value))
        throw Error(ExitCode::Usage, "the stability cases set " + path + ", which is no key of a shot");
}

}  // namespace

std::string Method::name() const {
    return is_path() ? "path" : scattering_;
}

// The keys of a method are named after it.
void Method::apply_to(Shot& shot, int seed, std::optional<int> paths) const {
    shot.method = is_path() ? RenderMethod::Path : RenderMethod::LightingGrid;
    shot.scattering_methods.method = is_path() ? kLightingGridMethod : scattering_;
    if (!shares_noise())
        return;
    set(shot, name() + ".seed", seed);
    set(shot, name() + ".paths", paths.value_or(kPaths));
}

const std::vector<Method>& all_methods() {
    static const std::vector<Method> methods = [] {
        std::vector<Method> all = {Method(kLightingGridMethod), Method()};
        for (const ScatteringMethod& method : scattering_methods())
            all.emplace_back(method.name);
        return all;
    }();
    return methods;
}

}  // namespace brisance::stability
