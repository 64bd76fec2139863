// The finished page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace brisance {

// One HTML file with the report's data and pictures in it.
std::string report_page(const nlohmann::ordered_json& report, const nlohmann::ordered_json& pictures);

// The data of one scene of a page with several.
struct ScenePage {
    nlohmann::ordered_json report, pictures;
};

// One HTML file with the scenes of a suite, of which it shows one at a time, under the suite's own data.
std::string suite_page(const nlohmann::ordered_json& suite, const std::vector<ScenePage>& scenes);

// JSON inside of a <script> element: no text of it can end the element or begin a comment.
std::string script_json(const nlohmann::ordered_json& json);

}  // namespace brisance
