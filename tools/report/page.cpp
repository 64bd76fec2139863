#include "page.h"

#include <cassert>
#include <string_view>

#include "page_template.h"

namespace brisance {
namespace {

constexpr std::string_view kMarker = "<!--DATA-->";

std::string data_element(const std::string& id, const nlohmann::ordered_json& json) {
    return "<script type=\"application/json\" id=\"" + id + "\">" + script_json(json) + "</script>\n";
}

std::string filled(const std::string& data) {
    const std::string_view page = page_template();
    const std::size_t marker = page.find(kMarker);
    assert(marker != std::string_view::npos);
    return std::string(page.substr(0, marker)) + data + std::string(page.substr(marker + kMarker.size()));
}

}  // namespace

std::string script_json(const nlohmann::ordered_json& json) {
    const std::string text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string escaped;
    escaped.reserve(text.size());
    // In JSON this sign stands inside of strings only.
    for (const char c : text)
        c == '<' ? escaped += "\\u003c" : escaped += c;
    return escaped;
}

std::string report_page(const nlohmann::ordered_json& report, const nlohmann::ordered_json& pictures) {
    return filled(data_element("report-data", report) + data_element("report-pictures", pictures));
}

std::string suite_page(const nlohmann::ordered_json& suite, const std::vector<ScenePage>& scenes) {
    std::string data = data_element("suite-data", suite);
    for (std::size_t i = 0; i < scenes.size(); ++i)
        data += data_element("report-data-" + std::to_string(i), scenes[i].report) +
                data_element("report-pictures-" + std::to_string(i), scenes[i].pictures);
    return filled(data);
}

}  // namespace brisance
