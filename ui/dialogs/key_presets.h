// The keys of actions: which they have by default, under a preset of another program, and by choice.
#pragma once

#include <QKeySequence>
#include <QList>
#include <QSet>
#include <QString>
#include <optional>

#include "app/settings.h"

namespace tessera {

// An action as the key table and the cheat sheet show it.
struct KeyRow {
    QString name;      // in the action table and in the settings
    QString text;      // for people, without '&'
    QString menu;      // likewise; rows of a menu follow each other
    QKeySequence def;  // Tessera's own; may be empty
    QKeySequence current;
    QList<QKeySequence> further = {};  // that it also has while `current` is `def`
};

// What a preset says of an action: its key, which may be empty; none where it says nothing.
std::optional<QKeySequence> presetKey(KeyPreset preset, const QString& action);

// The key of each row under a preset: the preset's, else the default, unless the preset gives that to another
// of the rows.
QList<QKeySequence> presetKeys(KeyPreset preset, const QList<KeyRow>& rows);

// The current key of a row and its further ones, without those that another row has as its current: they are
// the first to give way.
QList<QKeySequence> keysInForce(const QList<KeyRow>& rows, int row);

// The rows whose current key another row has too.
QSet<int> conflictingRows(const QList<KeyRow>& rows);

// "Tessera", "Illustrator", "Inkscape".
QString presetName(KeyPreset preset);

}  // namespace tessera
