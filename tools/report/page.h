// The finished page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace brisance {

// One HTML file with the report's data and pictures in it.
std::string report_page(const nlohmann::ordered_json& report, const nlohmann::ordered_json& pictures);

// JSON inside of a <script> element: no text of it can end the element or begin a comment.
std::string script_json(const nlohmann::ordered_json& json);

}  // namespace brisance
