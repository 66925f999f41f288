// What the program remembers between runs, by name and type; the window's own bytes are opaque.
#pragma once

#include <QByteArray>
#include <QKeySequence>
#include <QSettings>
#include <QStringList>
#include <optional>

#include "app/tools/tool_options.h"

namespace tessera {

enum class Theme { System, Dark, Light };

// Which program's keys the actions have, where the user has not chosen others.
enum class KeyPreset { Tessera, Illustrator, Inkscape };

// A typed view of one QSettings file in the user's configuration folder. For the UI thread.
class Settings {
  public:
    Settings();

    QStringList recentFiles() const;  // newest first, at most kMaxRecent, existing files only
    void addRecentFile(const QString& path);
    void clearRecentFiles();

    QString folder() const;  // where the last dialog ended; the pictures folder at first
    // Not where it is in the program's cache, which nobody looks into.
    void setFolder(const QString& folder);
    // The path, or that name in folder() where the path is in the program's cache.
    QString outsideCache(const QString& path) const;

    Theme theme() const;
    void setTheme(Theme theme);

    // What says how many patches there shall be: "patches", "detail" (0..1, as patchesForDetail has it) or
    // "error" (the mean, in levels of 255).
    QString amount() const;
    void setAmount(const QString& amount);
    int patches() const;
    void setPatches(int patches);
    double detail() const;
    void setDetail(double detail);
    double meanError() const;
    void setMeanError(double levels);
    // A preset of core/vectorize/quality.h.
    QString quality() const;
    void setQuality(const QString& preset);
    // 0..1, as featureShare has it.
    double features() const;
    void setFeatures(double share);
    // The least contrast of a feature, as a share of the picture's strongest edge (the method's cannyHigh).
    double edgeContrast() const;
    void setEdgeContrast(double share);
    bool vectorizeOnOpen() const;
    void setVectorizeOnOpen(bool on);
    bool embedPhoto() const;
    void setEmbedPhoto(bool on);

    KeyPreset keyPreset() const;
    void setKeyPreset(KeyPreset preset);
    // The key that the user chose for an action, if any; an empty one is a choice too.
    std::optional<QKeySequence> key(const QString& actionId) const;
    // None goes back to the preset's.
    void setKey(const QString& actionId, const std::optional<QKeySequence>& key);

    // 0 is never.
    int autosaveSeconds() const;
    void setAutosaveSeconds(int seconds);
    // For jobs; 0 is one for each core.
    int threads() const;
    void setThreads(int threads);
    int historyMegabytes() const;
    void setHistoryMegabytes(int megabytes);
    size_t historyBytes() const { return size_t(historyMegabytes()) << 20; }

    // What the tools' bar was left at.
    ToolOptions toolOptions() const;
    void setToolOptions(const ToolOptions& options);

    QByteArray blob(const QString& name) const;
    void setBlob(const QString& name, const QByteArray& bytes);

    static constexpr int kMaxRecent = 10;
    static constexpr int kMinHistoryMegabytes = 16, kMaxHistoryMegabytes = 64 * 1024;
    static constexpr int kMaxAutosaveSeconds = 3600;
    static constexpr int kMaxThreads = 256;

  private:
    mutable QSettings mSettings;
};

}  // namespace tessera
