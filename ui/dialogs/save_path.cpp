// See save_path.h.
#include "ui/dialogs/save_path.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QRegularExpression>
#include <algorithm>

namespace tessera {

namespace {

// With their dots.
QStringList suffixesIn(const QString& filter) {
    static const QRegularExpression pattern("\\*(\\.\\w+)");
    QStringList suffixes;
    for (auto matches = pattern.globalMatch(filter); matches.hasNext();)
        suffixes.append(matches.next().captured(1));
    return suffixes;
}

bool mayReplace(QWidget* parent, const QString& title, const QString& path) {
    const QString text = QObject::tr("“%1” exists already. Replace it?").arg(QFileInfo(path).fileName());
    return QMessageBox::question(parent, title, text, QMessageBox::Yes | QMessageBox::No, QMessageBox::No) ==
           QMessageBox::Yes;
}

}  // namespace

QString askForSavePath(QWidget* parent, const QString& title, const QString& suggested,
                       const QString& filter) {
    const QStringList suffixes = suffixesIn(filter);
    QString path = suggested;
    for (;;) {
        path = QFileDialog::getSaveFileName(parent, title, path, filter);
        const bool complete = std::any_of(suffixes.begin(), suffixes.end(), [&](const QString& suffix) {
            return path.endsWith(suffix, Qt::CaseInsensitive);
        });
        if (path.isEmpty() || complete) return path;
        // The dialog has asked about another name than the one that will be written.
        path += suffixes.first();
        if (!QFileInfo::exists(path) || mayReplace(parent, title, path)) return path;
    }
}

}  // namespace tessera
