// See conversions.h.
#include "ui/conversions.h"

#include <QMimeData>
#include <QUrl>
#include <algorithm>

namespace tessera {

QColor toQColor(glm::dvec3 srgb) {
    const auto channel = [](double value) { return float(std::clamp(value, 0., 1.)); };
    return QColor::fromRgbF(channel(srgb.x), channel(srgb.y), channel(srgb.z));
}

glm::dvec3 toSrgb(const QColor& colour) {
    return glm::dvec3(colour.red(), colour.green(), colour.blue()) / 255.;
}

QStringList localFiles(const QMimeData* data) {
    QStringList files;
    for (const QUrl& url : data->urls())
        if (url.isLocalFile()) files.append(url.toLocalFile());
    return files;
}

}  // namespace tessera
