// Whether two images ought to look the same, by the shots stored with them.
#pragma once

#include <string>
#include <vector>

namespace brisance {

// One line for each key that defines the true picture (Affects::Picture) and differs between two shots as to_json wrote
// them: "smoke.mean_cosine: 0.4 against 0". A key that one of them lacks, as images of older versions do, has its
// default there; a key unknown here counts by its path. volume.file is compared by its file name, as folders differ
// between machines. Empty: one and the same picture is meant. Throws Error BadData for text that is no JSON object.
std::vector<std::string> scene_differences(const std::string& shot_json_a, const std::string& shot_json_b);

// The same of all keys but output.path, whatever they affect.
std::vector<std::string> setting_differences(const std::string& shot_json_a, const std::string& shot_json_b);

}  // namespace brisance
