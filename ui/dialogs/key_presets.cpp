// See key_presets.h.
#include "ui/dialogs/key_presets.h"

#include <QHash>
#include <algorithm>
#include <span>

namespace tessera {

namespace {

struct PresetKey {
    const char* action;
    const char* key;  // portable; empty takes the key away
};

// Only where they differ from Tessera's own, which have Illustrator's tools and Inkscape's views already.
constexpr PresetKey kIllustrator[] = {
    {"redo", "Ctrl+Shift+Z"},  {"export", "Ctrl+Alt+E"},        {"exportAgain", "Ctrl+Alt+Shift+E"},
    {"showEdges", "Ctrl+Y"},   {"showControlPoints", "Ctrl+H"}, {"fullScreen", "F"},
    {"preferences", "Ctrl+K"}, {"toolGradient", "G"},
};

constexpr PresetKey kInkscape[] = {
    {"export", "Ctrl+Shift+E"},
    {"exportAgain", "Ctrl+Alt+E"},
    {"zoomIn", "+"},
    {"zoomOut", "-"},
    {"zoom100", "1"},
    {"zoomFit", "4"},
    {"fitSelection", "3"},
    {"previousZoom", "`"},
    {"hidePanels", "F12"},
    {"invertSelection", "!"},
    {"preferences", "Ctrl+Shift+P"},
    {"toolSelect", "S"},
    {"toolDirect", "N"},
    {"toolEyedropper", "D"},
    {"toolBrush", "W"},
    {"toolGradient", "G"},
    {"toolZoom", "Z"},
};

std::span<const PresetKey> tableOf(KeyPreset preset) {
    switch (preset) {
        case KeyPreset::Illustrator:
            return kIllustrator;
        case KeyPreset::Inkscape:
            return kInkscape;
        case KeyPreset::Tessera:
            return {};
    }
    return {};
}

}  // namespace

std::optional<QKeySequence> presetKey(KeyPreset preset, const QString& action) {
    for (const PresetKey& entry : tableOf(preset))
        if (action == QLatin1String(entry.action)) return QKeySequence(entry.key, QKeySequence::PortableText);
    return {};
}

QList<QKeySequence> presetKeys(KeyPreset preset, const QList<KeyRow>& rows) {
    QSet<QKeySequence> taken;
    for (const KeyRow& row : rows)
        if (const auto own = presetKey(preset, row.name)) taken.insert(*own);
    QList<QKeySequence> keys;
    for (const KeyRow& row : rows) {
        const auto own = presetKey(preset, row.name);
        keys.append(own ? *own : taken.contains(row.def) ? QKeySequence() : row.def);
    }
    return keys;
}

QList<QKeySequence> keysInForce(const QList<KeyRow>& rows, int row) {
    const KeyRow& asked = rows[row];
    if (asked.current.isEmpty()) return {};
    QList<QKeySequence> keys{asked.current};
    if (asked.current != asked.def) return keys;
    for (const QKeySequence& key : asked.further)
        if (std::none_of(rows.begin(), rows.end(), [&](const KeyRow& other) { return other.current == key; }))
            keys.append(key);
    return keys;
}

QSet<int> conflictingRows(const QList<KeyRow>& rows) {
    QHash<QKeySequence, int> first;
    QSet<int> conflicting;
    for (int i = 0; i < rows.size(); ++i) {
        const QKeySequence& key = rows[i].current;
        if (key.isEmpty()) continue;
        if (const auto before = first.constFind(key); before != first.constEnd())
            conflicting << *before << i;
        else
            first.insert(key, i);
    }
    return conflicting;
}

QString presetName(KeyPreset preset) {
    switch (preset) {
        case KeyPreset::Illustrator:
            return QStringLiteral("Illustrator");
        case KeyPreset::Inkscape:
            return QStringLiteral("Inkscape");
        case KeyPreset::Tessera:
            return QStringLiteral("Tessera");
    }
    return {};
}

}  // namespace tessera
