// See swatch_store.h.
#include "app/swatch_store.h"

#include <QDir>
#include <QFileInfo>
#include <QStandardPaths>
#include <algorithm>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace tessera {

namespace {

// As the file holds them.
bool sameColour(glm::dvec3 a, glm::dvec3 b) {
    return glm::all(glm::lessThan(glm::abs(a - b), glm::dvec3(.5 / 255)));
}

}  // namespace

SwatchStore::SwatchStore(QString path, QObject* parent) : QObject(parent), mPath(std::move(path)) {
    if (const auto stored = readGpl(mPath)) mList = *stored;
    mList.name = tr("My swatches");
}

QString SwatchStore::defaultPath() {
    return QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)).filePath("swatches.gpl");
}

void SwatchStore::add(const std::vector<Swatch>& swatches) {
    std::vector<Swatch> fresh;
    for (const Swatch& swatch : swatches) {
        const auto same = [&](const Swatch& other) { return sameColour(other.colour, swatch.colour); };
        if (std::none_of(fresh.begin(), fresh.end(), same) &&
            std::none_of(mList.swatches.begin(), mList.swatches.end(), same))
            fresh.push_back(swatch);
    }
    if (fresh.empty()) return;
    mList.swatches.insert(mList.swatches.begin(), fresh.begin(), fresh.end());
    save();
}

void SwatchStore::remove(size_t index) {
    mList.swatches.erase(mList.swatches.begin() + std::ptrdiff_t(index));
    save();
}

void SwatchStore::save() {
    QDir().mkpath(QFileInfo(mPath).path());
    (void)writeGpl(mPath, mList);
    emit changed();
}

}  // namespace tessera
