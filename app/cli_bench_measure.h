// What `tessera-cli bench` measures of one vectorization at the picture's own size.
#pragma once

#include <string>

#include "app/cli_support.h"
#include "core/image/image_io.h"
#include "core/vectorize/settings.h"

namespace tessera::cli {

// A patch whose base triangle has an angle below this is a sliver.
constexpr double kSliverDegrees = 8;

// The picture at `path`, named by that path in an error.
Result<Image> readPicture(const std::string& path);

// Vectorizes the picture and measures the result: one flat object of named figures, and "stages", the report.
// "seconds" and "cpu_seconds" are those of the vectorization; "peak_rss_mb" is the process's up to its end,
// with the picture. Errors are of the rendering at the picture's size with 4 samples a pixel; seams are of
// the document as stored.
Result<Json> measureRun(const std::string& path, const VectorizeSettings& settings);

}  // namespace tessera::cli
