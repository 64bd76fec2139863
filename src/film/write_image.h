// Writes frames; each file appears whole or not at all. This header does not include OpenEXR.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "film/image.h"
#include "film/settings.h"

namespace brisance {

// What could not be stored as it was.
struct ExrReport {
    std::uint64_t clamped = 0;     // values beyond the largest half (65504), stored as that
    float all_lost = 0.0f;         // the brightest colour of a picture that is all black as halves; 0: it is not
    std::string describe() const;  // one line; empty when there is nothing to report
};

// Scan-line EXR, ZIP, half (float where the layer says so). Beauty channels bare, others "layer.channel"; a one-channel
// layer named as its channel ("Z") is written bare. Written to a temporary file in the same folder, then renamed.
// With SOURCE_DATE_EPOCH set, equal images and metadata give equal bytes: the capture date is that time in UTC, and the
// render time is left out.
// Throws Error RenderFailed for an image with a NaN or an infinite value: nothing is written then. Throws CannotCreate
// (folder missing or not writable) or OutputFailed (no space left).
ExrReport write_exr(const std::filesystem::path& file, const Image& image, const ImageMetadata& metadata);

// 8-bit PNG of the beauty under a view transform at `exposure_stops`; alpha is dropped over black.
void write_png(const std::filesystem::path& file, const Image& image, float exposure_stops, ViewTransform view);

// The same of finished pixels: display-encoded, three numbers per pixel, rows from the top.
void write_png(const std::filesystem::path& file, int width, int height, const std::vector<std::uint8_t>& rgb);

// Writes text as a whole file, by temporary file and rename.
void write_text(const std::filesystem::path& file, const std::string& text);

// Reads an EXR's channels back as float; layers regrouped as write_exr wrote them, the beauty first and the others by
// name. Pixels of the display window that lie outside the data window are 0.
// Throws Error MissingInput or BadData.
Image read_exr(const std::filesystem::path& file);

// Data in the header of an EXR by any program; absent members are not in the header.
struct ExrMetadata {
    std::optional<int> frame;                 // imageCounter
    std::optional<double> render_seconds;     // renderTimeSeconds
    std::optional<dmat4> ndc_from_world;      // worldToNDC: x to the right, y down in [0, 1], over w, the depth
    std::map<std::string, std::string> text;  // every text attribute by its name: "brisance/shot", "comments", ...
};

// Reads no pixels. Throws Error MissingInput or BadData, as read_exr.
ExrMetadata read_exr_metadata(const std::filesystem::path& file);

// The exposure [stops] that brings the image's bright parts (a high percentile of luminance) just below white.
float automatic_exposure(const Image& image);

}  // namespace brisance
