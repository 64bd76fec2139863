// Writing frames: each file appears whole or not at all. The only door to OpenEXR and OpenImageIO.
#pragma once

#include <filesystem>
#include <string>

#include "film/image.h"
#include "film/settings.h"

namespace brisance {

// Scan-line EXR, ZIP, half (float where the layer says so). Beauty channels bare, others "layer.channel"; a one-channel
// layer named as its channel ("Z") is written bare. Written to a temporary file in the same folder, then renamed.
// Throws Error CannotCreate (folder missing or not writable) or OutputFailed (no space left).
void write_exr(const std::filesystem::path& file, const Image& image, const ImageMetadata& metadata);

// 8-bit PNG of the beauty under a view transform at `exposure_stops`; alpha is dropped over black.
void write_png(const std::filesystem::path& file, const Image& image, float exposure_stops, ViewTransform view);

// Writes text as a whole file, by temporary file and rename.
void write_text(const std::filesystem::path& file, const std::string& text);

// Reads an EXR's channels back as float; layers regrouped as write_exr wrote them.
// Throws Error MissingInput or BadData.
Image read_exr(const std::filesystem::path& file);

// The exposure [stops] that brings the image's bright parts (a high percentile of luminance) just below white.
float automatic_exposure(const Image& image);

}  // namespace brisance
