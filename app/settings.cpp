// See settings.h.
#include "app/settings.h"

#include <QDir>
#include <QFileInfo>
#include <QStandardPaths>

#include "app/history.h"
#include "core/edit/enclosed_region.h"
#include "core/vectorize/quality.h"
#include "core/vectorize/settings.h"

namespace tessera {

namespace {

constexpr int kDefaultPatches = 2000;
constexpr double kDefaultDetail = .6;
constexpr double kDefaultMeanError = 3;
constexpr int kDefaultAutosaveSeconds = 120;

bool inCache(const QString& path) {
    const QString cache = QStandardPaths::writableLocation(QStandardPaths::CacheLocation);
    return (QDir::cleanPath(path) + '/').startsWith(QDir::cleanPath(cache) + '/');
}

template <class Value>
struct Named {
    Value value;
    const char* name;
};

constexpr Named<Theme> kThemes[] = {
    {Theme::System, "system"}, {Theme::Dark, "dark"}, {Theme::Light, "light"}};
constexpr Named<KeyPreset> kKeyPresets[] = {{KeyPreset::Tessera, "tessera"},
                                            {KeyPreset::Illustrator, "illustrator"},
                                            {KeyPreset::Inkscape, "inkscape"}};
constexpr Named<ColourSource> kColourSources[] = {{ColourSource::Vector, "vector"},
                                                  {ColourSource::Original, "original"}};

template <class Value, size_t kCount>
std::optional<Value> named(const Named<Value> (&table)[kCount], const QString& name) {
    for (const Named<Value>& entry : table)
        if (name == entry.name) return entry.value;
    return {};
}

template <class Value, size_t kCount>
QString nameOf(const Named<Value> (&table)[kCount], Value value) {
    for (const Named<Value>& entry : table)
        if (value == entry.value) return entry.name;
    return {};
}

// A number of the file, which anybody may have edited, within its range.
template <class Number>
Number bounded(const QVariant& value, Number otherwise, Number least, Number most) {
    bool isNumber = false;
    const double number = value.toDouble(&isNumber);
    return isNumber && number >= double(least) && number <= double(most) ? Number(number) : otherwise;
}

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
    if (!folder.isEmpty() && QFileInfo(folder).isDir() && !inCache(folder)) return folder;
    for (const auto place : {QStandardPaths::PicturesLocation, QStandardPaths::DocumentsLocation}) {
        const QString usual = QStandardPaths::writableLocation(place);
        if (QFileInfo(usual).isDir()) return usual;
    }
    return QDir::homePath();
}

void Settings::setFolder(const QString& folder) {
    if (!inCache(folder)) mSettings.setValue("files/folder", folder);
}

QString Settings::outsideCache(const QString& path) const {
    return inCache(path) ? QDir(folder()).filePath(QFileInfo(path).fileName()) : path;
}

Theme Settings::theme() const {
    return named(kThemes, mSettings.value("window/theme").toString()).value_or(Theme::Dark);
}

void Settings::setTheme(Theme theme) {
    mSettings.setValue("window/theme", nameOf(kThemes, theme));
}

QString Settings::amount() const {
    return mSettings.value("vectorize/amount", "patches").toString();
}

void Settings::setAmount(const QString& amount) {
    mSettings.setValue("vectorize/amount", amount);
}

double Settings::detail() const {
    return mSettings.value("vectorize/detail", kDefaultDetail).toDouble();
}

void Settings::setDetail(double detail) {
    mSettings.setValue("vectorize/detail", detail);
}

double Settings::meanError() const {
    return mSettings.value("vectorize/meanError", kDefaultMeanError).toDouble();
}

void Settings::setMeanError(double levels) {
    mSettings.setValue("vectorize/meanError", levels);
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

void Settings::setKey(const QString& actionId, const std::optional<QKeySequence>& key) {
    if (key)
        mSettings.setValue("keys/" + actionId, key->toString(QKeySequence::PortableText));
    else
        mSettings.remove("keys/" + actionId);
}

KeyPreset Settings::keyPreset() const {
    return named(kKeyPresets, mSettings.value("window/keyPreset").toString()).value_or(KeyPreset::Tessera);
}

void Settings::setKeyPreset(KeyPreset preset) {
    mSettings.setValue("window/keyPreset", nameOf(kKeyPresets, preset));
}

int Settings::autosaveSeconds() const {
    return bounded(mSettings.value("files/autosaveSeconds"), kDefaultAutosaveSeconds, 0, kMaxAutosaveSeconds);
}

void Settings::setAutosaveSeconds(int seconds) {
    mSettings.setValue("files/autosaveSeconds", seconds);
}

int Settings::threads() const {
    return bounded(mSettings.value("system/threads"), 0, 0, kMaxThreads);
}

void Settings::setThreads(int threads) {
    mSettings.setValue("system/threads", threads);
}

int Settings::historyMegabytes() const {
    return bounded(mSettings.value("system/historyMegabytes"), int(History::kDefaultMemoryLimit >> 20),
                   kMinHistoryMegabytes, kMaxHistoryMegabytes);
}

void Settings::setHistoryMegabytes(int megabytes) {
    mSettings.setValue("system/historyMegabytes", megabytes);
}

ToolOptions Settings::toolOptions() const {
    ToolOptions options;
    const auto number = [&](const char* name, double& value, double least, double most) {
        value = bounded(mSettings.value(QString("tools/") + name), value, least, most);
    };
    const auto flag = [&](const char* name, bool& value) {
        value = mSettings.value(QString("tools/") + name, value).toBool();
    };
    const auto colour = [&](const char* name, glm::dvec3& value) {
        const QStringList parts = mSettings.value(QString("tools/") + name).toStringList();
        for (int c = 0; c < 3 && parts.size() == 3; ++c)
            value[c] = bounded(QVariant(parts[c]), value[c], 0., 1.);
    };
    colour("colour", options.colour);
    colour("secondColour", options.secondColour);
    number("wandTolerance", options.wand.tolerance, 0, 2);
    flag("wandContiguous", options.wand.contiguous);
    flag("wandStopsAtFeatures", options.wand.stopAtFeatures);
    number("gapPx", options.gapPx, 0, kMostGapPx);
    options.eyedropper =
        named(kColourSources, mSettings.value("tools/eyedropper").toString()).value_or(options.eyedropper);
    number("brushRadiusPx", options.brushRadiusPx, .1, 1e4);
    number("brushHardness", options.brushHardness, 0, 1);
    number("brushStrength", options.brushStrength, 0, 1);
    flag("brushKeepsShading", options.brushKeepsShading);
    number("gradientStrength", options.gradientStrength, 0, 1);
    number("featherPx", options.featherPx, 0, 1e4);
    flag("allHandles", options.allHandles);
    flag("refitAfterReshape", options.refitAfterReshape);
    flag("wholeFeatures", options.wholeFeatures);
    return options;
}

void Settings::setToolOptions(const ToolOptions& options) {
    const auto put = [&](const char* name, const QVariant& value) {
        mSettings.setValue(QString("tools/") + name, value);
    };
    const auto parts = [](glm::dvec3 colour) {
        QStringList list;
        for (int c = 0; c < 3; ++c) list.append(QString::number(colour[c], 'g', 17));
        return list;
    };
    put("colour", parts(options.colour));
    put("secondColour", parts(options.secondColour));
    put("wandTolerance", options.wand.tolerance);
    put("wandContiguous", options.wand.contiguous);
    put("wandStopsAtFeatures", options.wand.stopAtFeatures);
    put("gapPx", options.gapPx);
    put("eyedropper", nameOf(kColourSources, options.eyedropper));
    put("brushRadiusPx", options.brushRadiusPx);
    put("brushHardness", options.brushHardness);
    put("brushStrength", options.brushStrength);
    put("brushKeepsShading", options.brushKeepsShading);
    put("gradientStrength", options.gradientStrength);
    put("featherPx", options.featherPx);
    put("allHandles", options.allHandles);
    put("refitAfterReshape", options.refitAfterReshape);
    put("wholeFeatures", options.wholeFeatures);
}

QByteArray Settings::blob(const QString& name) const {
    return mSettings.value("window/" + name).toByteArray();
}

void Settings::setBlob(const QString& name, const QByteArray& bytes) {
    mSettings.setValue("window/" + name, bytes);
}

}  // namespace tessera
