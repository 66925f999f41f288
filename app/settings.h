// What the program remembers between runs, by name and type; the window's own bytes are opaque.
#pragma once

#include <QByteArray>
#include <QKeySequence>
#include <QSettings>
#include <QStringList>
#include <optional>

namespace tessera {

enum class Theme { Dark, Light };

// A typed view of one QSettings file in the user's configuration folder. For the UI thread.
class Settings {
  public:
    Settings();

    QStringList recentFiles() const;  // newest first, at most kMaxRecent, existing files only
    void addRecentFile(const QString& path);
    void clearRecentFiles();

    QString folder() const;  // where the last dialog ended; the pictures folder at first
    void setFolder(const QString& folder);

    Theme theme() const;
    void setTheme(Theme theme);

    int patches() const;
    void setPatches(int patches);
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

    // The key that the user chose for an action, if any.
    std::optional<QKeySequence> key(const QString& actionId) const;

    QByteArray blob(const QString& name) const;
    void setBlob(const QString& name, const QByteArray& bytes);

    static constexpr int kMaxRecent = 10;

  private:
    mutable QSettings mSettings;
};

}  // namespace tessera
