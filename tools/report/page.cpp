#include "page.h"

#include <cassert>
#include <string_view>

#include "page_template.h"

namespace brisance {
namespace {

constexpr std::string_view kMarker = "<!--DATA-->";

std::string data_element(const char* id, const nlohmann::ordered_json& json) {
    return std::string("<script type=\"application/json\" id=\"") + id + "\">" + script_json(json) + "</script>\n";
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
    const std::string_view page = page_template();
    const std::size_t marker = page.find(kMarker);
    assert(marker != std::string_view::npos);
    return std::string(page.substr(0, marker)) + data_element("report-data", report) +
           data_element("report-pictures", pictures) + std::string(page.substr(marker + kMarker.size()));
}

}  // namespace brisance
