// See gpl.h.
#include "app/gpl.h"

#include <QFile>
#include <QFileInfo>
#include <QObject>
#include <algorithm>
#include <cmath>

#include "core/base/atomic_file.h"

namespace tessera {

namespace {

const char* const kMagic = "GIMP Palette";

tl::unexpected<Error> unreadable(const QString& source, const QString& why) {
    return failure(ErrorCode::CannotRead,
                   QObject::tr("cannot read the swatches of %1: %2").arg(source, why).toStdString());
}

// "  R   G   B  name", the name optional; else why it cannot be read.
tl::expected<Swatch, QString> parseSwatch(const QString& line) {
    Swatch swatch;
    qsizetype at = 0;
    for (int c = 0; c < 3; ++c) {
        while (at < line.size() && line[at].isSpace()) ++at;
        const qsizetype begin = at;
        while (at < line.size() && !line[at].isSpace()) ++at;
        bool isNumber = false;
        const int value = line.mid(begin, at - begin).toInt(&isNumber);
        if (!isNumber)
            return tl::unexpected(QObject::tr("there should be three numbers, red, green and blue"));
        if (value < 0 || value > 255) return tl::unexpected(QObject::tr("%1 is not in 0..255").arg(value));
        swatch.colour[c] = value / 255.;
    }
    swatch.name = line.mid(at).trimmed();
    return swatch;
}

}  // namespace

Result<SwatchList> parseGpl(const QByteArray& text, const QString& source) {
    if (text.size() > kMaxGplBytes)
        return unreadable(source, QObject::tr("the file is too large for a list of swatches"));
    const QStringList lines = QString::fromUtf8(text).split('\n');
    if (lines.first().trimmed() != kMagic)
        return unreadable(source, QObject::tr("it does not begin with \"%1\"").arg(kMagic));
    SwatchList list;
    bool inHeader = true;
    for (qsizetype i = 1; i < lines.size(); ++i) {
        const QString line = lines[i].trimmed();
        if (line.isEmpty() || line.startsWith('#')) continue;
        if (inHeader && line.startsWith("Name:")) {
            list.name = line.mid(5).trimmed();
            continue;
        }
        if (inHeader && line.startsWith("Columns:")) continue;
        inHeader = false;
        const auto swatch = parseSwatch(line);
        if (!swatch) return unreadable(source, QObject::tr("line %1: %2").arg(i + 1).arg(swatch.error()));
        list.swatches.push_back(*swatch);
    }
    return list;
}

QByteArray gplText(const SwatchList& list) {
    QString text = QString("%1\nName: %2\n#\n").arg(kMagic, list.name.simplified());
    for (const Swatch& swatch : list.swatches) {
        for (int c = 0; c < 3; ++c)
            text += QString("%1 ").arg(std::lround(255 * std::clamp(swatch.colour[c], 0., 1.)), 3);
        text.back() = '\t';
        text += swatch.name.simplified() + '\n';
    }
    return text.toUtf8();
}

Result<SwatchList> readGpl(const QString& path) {
    QFile file(path);
    const QString name = QFileInfo(path).fileName();
    if (!file.open(QIODevice::ReadOnly)) return unreadable(name, file.errorString());
    return parseGpl(file.read(kMaxGplBytes + 1), name);
}

Result<void> writeGpl(const QString& path, const SwatchList& list) {
    const QByteArray text = gplText(list);
    return writeFileAtomically(path.toStdString(),
                               std::span(reinterpret_cast<const uint8_t*>(text.data()), size_t(text.size())));
}

}  // namespace tessera
