// Draws the centres of the patches' colour splines, of constant size on the screen.
#pragma once

#include <QPainter>

#include "core/mesh/patch_mesh.h"
#include "ui/view_transform.h"

namespace tessera {

// In device pixels, as OverlayPainter::paint. Those of patches that are too small on the screen for them are
// left out.
void paintCentres(QPainter& painter, const PatchMesh& mesh, const ViewTransform& view, const QRectF& visible,
                  double pixelRatio);

}  // namespace tessera
