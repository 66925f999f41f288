// The user's own swatches, kept between runs.
#pragma once

#include <QObject>

#include "app/gpl.h"

namespace tessera {

// Lives in a .gpl file, which every change writes. A file that cannot be read counts as none; one that cannot
// be written leaves the swatches to this run.
class SwatchStore : public QObject {
    Q_OBJECT

  public:
    explicit SwatchStore(QString path, QObject* parent = nullptr);
    // In the program's folder of the user's data.
    static QString defaultPath();

    const std::vector<Swatch>& swatches() const { return mList.swatches; }
    // Puts those in front that are not there yet; of the same colours one is enough.
    void add(const std::vector<Swatch>& swatches);
    void remove(size_t index);

  signals:
    void changed();

  private:
    void save();

    QString mPath;
    SwatchList mList;
};

}  // namespace tessera
