// See settings.h.
#include "app/settings.h"

#include <QFileInfo>
#include <QStandardPaths>

#include "core/vectorize/quality.h"
#include "core/vectorize/settings.h"

namespace tessera {

namespace {

constexpr int kDefaultPatches = 2000;

}  // namespace

Settings::Settings() : mSettings(QSettings::IniFormat, QSettings::UserScope, "tessera", "tessera") {}

QStringList Settings::recentFiles() const {
    QStringList files = mSettings.value("files/recent").toStringList();
    files.removeIf([](const QString& path) { return !QFileInfo::exists(path); });
    return files;
}

void Settings::addRecentFile(const QString& path) {
    QStringList files = mSettings.value("files/recent").toStringList();
    const QString absolute = QFileInfo(path).absoluteFilePath();
    files.removeAll(absolute);
    files.prepend(absolute);
    mSettings.setValue("files/recent", QStringList(files.mid(0, kMaxRecent)));
}

void Settings::clearRecentFiles() {
    mSettings.remove("files/recent");
}

QString Settings::folder() const {
    const QString folder = mSettings.value("files/folder").toString();
    if (!folder.isEmpty() && QFileInfo(folder).isDir()) return folder;
    return QStandardPaths::writableLocation(QStandardPaths::PicturesLocation);
}

void Settings::setFolder(const QString& folder) {
    mSettings.setValue("files/folder", folder);
}

Theme Settings::theme() const {
    return mSettings.value("window/theme").toString() == "light" ? Theme::Light : Theme::Dark;
}

void Settings::setTheme(Theme theme) {
    mSettings.setValue("window/theme", theme == Theme::Light ? "light" : "dark");
}

int Settings::patches() const {
    return mSettings.value("vectorize/patches", kDefaultPatches).toInt();
}

void Settings::setPatches(int patches) {
    mSettings.setValue("vectorize/patches", patches);
}

QString Settings::quality() const {
    return mSettings.value("vectorize/quality", "standard").toString();
}

void Settings::setQuality(const QString& preset) {
    mSettings.setValue("vectorize/quality", preset);
}

double Settings::features() const {
    return mSettings.value("vectorize/features", featureShare({})).toDouble();
}

void Settings::setFeatures(double share) {
    mSettings.setValue("vectorize/features", share);
}

double Settings::edgeContrast() const {
    return mSettings.value("vectorize/edgeContrast", VectorizeSettings{}.cannyHigh).toDouble();
}

void Settings::setEdgeContrast(double share) {
    mSettings.setValue("vectorize/edgeContrast", share);
}

bool Settings::vectorizeOnOpen() const {
    return mSettings.value("vectorize/onOpen", true).toBool();
}

void Settings::setVectorizeOnOpen(bool on) {
    mSettings.setValue("vectorize/onOpen", on);
}

bool Settings::embedPhoto() const {
    return mSettings.value("files/embedPhoto", true).toBool();
}

void Settings::setEmbedPhoto(bool on) {
    mSettings.setValue("files/embedPhoto", on);
}

std::optional<QKeySequence> Settings::key(const QString& actionId) const {
    const QVariant value = mSettings.value("keys/" + actionId);
    if (!value.isValid()) return std::nullopt;
    return QKeySequence(value.toString(), QKeySequence::PortableText);
}

QByteArray Settings::blob(const QString& name) const {
    return mSettings.value("window/" + name).toByteArray();
}

void Settings::setBlob(const QString& name, const QByteArray& bytes) {
    mSettings.setValue("window/" + name, bytes);
}

}  // namespace tessera
