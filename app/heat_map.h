// How far the vector image is from the photo, pixel by pixel, as a picture to lay over it.
#pragma once

#include <QImage>
#include <QObject>
#include <QPointer>
#include <QTimer>

#include "app/document_session.h"
#include "app/jobs/job.h"

namespace tessera {

// The Euclidean distance of the pixels' RGB, in levels of 255: clear up to kHeatFromLevels, which nobody
// sees, then yellow, red from kHeatFullLevels on. Of the size of the photo, which is that of the mesh.
constexpr double kHeatFromLevels = 4, kHeatFullLevels = 48;
QRgb heatColour(double levels);  // premultiplied
Result<QImage> heatMap(const PatchMesh& mesh, const Image& photo, Progress& progress);

// Keeps the map of a document up to date on a worker while it is wanted.
class HeatMap : public QObject {
    Q_OBJECT

  public:
    explicit HeatMap(QObject* parent = nullptr);

    // Null for none.
    void setSession(DocumentSession* session);
    void setWanted(bool wanted);

  signals:
    // Null where there is none (any more).
    void ready(const QImage& map);

  private:
    void follow(const Change& change);
    void start();

    QPointer<DocumentSession> mSession;
    bool mWanted = false;
    QTimer mRest;  // between a change and the drawing, so that gestures do not wait for maps
    QPointer<Job> mJob;
};

}  // namespace tessera
