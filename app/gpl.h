// Swatch files of GIMP, which Inkscape, Krita and others read and write too (.gpl).
#pragma once

#include <QByteArray>
#include <QString>
#include <glm/vec3.hpp>
#include <vector>

#include "core/base/result.h"

namespace tessera {

struct Swatch {
    glm::dvec3 colour{0};  // gamma-encoded sRGB; of 1/255 in files
    QString name = {};

    bool operator==(const Swatch&) const = default;
};

struct SwatchList {
    QString name = {};
    std::vector<Swatch> swatches = {};

    bool operator==(const SwatchList&) const = default;
};

// Larger files are no lists of swatches.
constexpr qsizetype kMaxGplBytes = 4 << 20;

// An error (CannotRead) names `source` and the line that cannot be read.
Result<SwatchList> parseGpl(const QByteArray& text, const QString& source);
// Names lose their line breaks, which the format cannot hold, and spaces around them.
QByteArray gplText(const SwatchList& list);

Result<SwatchList> readGpl(const QString& path);
Result<void> writeGpl(const QString& path, const SwatchList& list);

}  // namespace tessera
