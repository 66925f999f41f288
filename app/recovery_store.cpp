// See recovery_store.h.
#include "app/recovery_store.h"

#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonDocument>
#include <QJsonObject>
#include <QStandardPaths>
#include <QUuid>
#include <algorithm>

#include "core/base/atomic_file.h"
#include "core/document/codec.h"

namespace tessera {

namespace {

constexpr const char* kLockName = "lock";
constexpr const char* kManifestSuffix = ".json";

QString newId() {
    return QUuid::createUuid().toString(QUuid::WithoutBraces);
}

QJsonObject readManifest(const QString& path) {
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly)) return {};
    return QJsonDocument::fromJson(file.readAll()).object();
}

std::span<const uint8_t> bytesOf(const QByteArray& bytes) {
    return {reinterpret_cast<const uint8_t*>(bytes.data()), size_t(bytes.size())};
}

}  // namespace

QString RecoverySlot::manifestPath() const {
    return QDir(mFolder).filePath(mId + kManifestSuffix);
}

QString RecoverySlot::dataPath(const QString& name) const {
    return QDir(mFolder).filePath(name);
}

QString RecoverySlot::currentData() const {
    const QString name = readManifest(manifestPath())["data"].toString();
    // Nothing but what write() has named: a manifest must not make us read files anywhere else.
    return name == mId + "-a.tessera" || name == mId + "-b.tessera" ? name : QString();
}

QString RecoverySlot::dataPath() const {
    const QString name = currentData();
    return name.isEmpty() ? QString() : dataPath(name);
}

std::optional<RecoveryInfo> RecoverySlot::info() const {
    const QJsonObject manifest = readManifest(manifestPath());
    if (!QFile::exists(dataPath())) return {};
    return RecoveryInfo{.path = manifest["path"].toString(),
                        .photoPath = manifest["photo"].toString(),
                        .time = QDateTime::fromString(manifest["time"].toString(), Qt::ISODateWithMs)};
}

Result<void> RecoverySlot::write(Document snapshot, const RecoveryInfo& info) {
    const Result<std::vector<uint8_t>> bytes = encodeDocument(snapshot);
    if (!bytes) return tl::unexpected<Error>(bytes.error());
    const Result<void> written = replace(*bytes, info);
    // Whoever forgot it meanwhile has left the files to us.
    if (mForgotten) forget();
    return written;
}

Result<void> RecoverySlot::replace(const std::vector<uint8_t>& bytes, const RecoveryInfo& info) {
    const std::lock_guard guard(mMutex);
    if (mForgotten) return {};
    const QString before = currentData();
    const QString name = mId + (before.endsWith("-a.tessera") ? "-b.tessera" : "-a.tessera");
    if (auto written = writeFileAtomically(dataPath(name).toStdString(), bytes); !written) return written;
    const QByteArray manifest =
        QJsonDocument(QJsonObject{{"data", name},
                                  {"path", info.path},
                                  {"photo", info.photoPath},
                                  {"time", info.time.toUTC().toString(Qt::ISODateWithMs)}})
            .toJson();
    if (auto written = writeFileAtomically(manifestPath().toStdString(), bytesOf(manifest)); !written)
        return written;
    if (!before.isEmpty()) QFile::remove(dataPath(before));
    return {};
}

void RecoverySlot::forget() {
    mForgotten = true;
    const std::unique_lock lock(mMutex, std::try_to_lock);
    if (!lock) return;
    QFile::remove(manifestPath());
    for (const char* end : {"-a.tessera", "-b.tessera"}) QFile::remove(dataPath(mId + end));
}

QString RecoveryStore::defaultRoot() {
    return QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) + "/tessera/recovery";
}

RecoveryStore::RecoveryStore(const QString& root) : mRoot(root), mFolder(QDir(root).filePath(newId())) {
    if (QDir().mkpath(mFolder)) lock(mFolder);
}

RecoveryStore::~RecoveryStore() {
    // The lock file goes with its lock; folders that then hold nothing go too.
    for (auto& [folder, lock] : mLocks) {
        lock.reset();
        QDir().rmdir(folder);
    }
}

bool RecoveryStore::lock(const QString& folder) {
    auto lock = std::make_unique<QLockFile>(QDir(folder).filePath(kLockName));
    // However old: only the end of the process that holds it makes a lock stale.
    lock->setStaleLockTime(0);
    if (!lock->tryLock()) return false;
    mLocks.emplace_back(folder, std::move(lock));
    return true;
}

std::shared_ptr<RecoverySlot> RecoveryStore::newSlot() {
    return usable() ? std::make_shared<RecoverySlot>(mFolder, newId()) : nullptr;
}

std::vector<std::shared_ptr<RecoverySlot>> RecoveryStore::leftBehind() {
    std::vector<std::pair<QDateTime, std::shared_ptr<RecoverySlot>>> found;
    const auto folders = QDir(mRoot).entryInfoList(QDir::Dirs | QDir::NoDotAndDotDot);
    for (const QFileInfo& folder : folders) {
        const QString path = folder.filePath();
        if (path == mFolder || !lock(path)) continue;
        const auto manifests = QDir(path).entryInfoList({QString("*") + kManifestSuffix}, QDir::Files);
        for (const QFileInfo& manifest : manifests) {
            auto slot = std::make_shared<RecoverySlot>(path, manifest.completeBaseName());
            if (const auto info = slot->info())
                found.emplace_back(info->time, std::move(slot));
            else
                slot->forget();
        }
        // Data without a manifest, and what was not renamed in time.
        const auto files = QDir(path).entryInfoList(QDir::Files | QDir::Hidden);
        for (const QFileInfo& file : files) {
            const bool wanted = file.fileName() == kLockName || file.suffix() == "json" ||
                                std::any_of(found.begin(), found.end(), [&](const auto& entry) {
                                    return entry.second->dataPath() == file.filePath();
                                });
            if (!wanted) QFile::remove(file.filePath());
        }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<std::shared_ptr<RecoverySlot>> left;
    for (auto& [time, slot] : found) left.push_back(std::move(slot));
    return left;
}

}  // namespace tessera
