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

void set(Shot& shot, const std::string& path, const Json& value) {
    const Key* const key = find_key(path);
    if (!key || !key->set(shot, value))
        throw Error(ExitCode::Usage, "the stability cases set " + path + ", which is no key of a shot");
}

// "estimator=point_beam": a number, true, false, or a word.
void set_of_preset(Shot& shot, const std::string& section, const std::string& setting) {
    const std::size_t equals = setting.find('=');
    const std::string text = setting.substr(equals + 1);
    const Json value = Json::parse(text, nullptr, false);
    set(shot, section + "." + setting.substr(0, equals), value.is_discarded() ? Json(text) : value);
}

}  // namespace

std::string Method::base() const {
    return is_path() ? "path" : scattering_;
}

std::string Method::name() const {
    return preset_.empty() ? base() : preset_;
}

// The keys of a method are named after it.
void Method::apply_to(Shot& shot, int seed, std::optional<int> paths) const {
    shot.method = is_path() ? RenderMethod::Path : RenderMethod::LightingGrid;
    shot.scattering_methods.method = is_path() ? kLightingGridMethod : scattering_;
    if (!shares_noise())
        return;
    for (const std::string& setting : settings_)
        set_of_preset(shot, base(), setting);
    set(shot, base() + ".seed", seed);
    set(shot, base() + ".paths", paths.value_or(kPaths));
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

const std::vector<Method>& preset_methods() {
    static const std::vector<Method> methods = [] {
        std::vector<Method> all;
        for (const ScatteringMethod& method : scattering_methods())
            for (const MethodPreset& preset : method.presets)
                if (preset.label != method.name)
                    all.emplace_back(method.name, preset);
        return all;
    }();
    return methods;
}

}  // namespace brisance::stability
