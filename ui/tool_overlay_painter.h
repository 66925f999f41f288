// Draws what the tool in use wants to be seen over the picture, of constant size on the screen.
#pragma once

#include <QPainter>

#include "app/tools/tool_overlay.h"
#include "ui/overlay_painter.h"
#include "ui/view_transform.h"

namespace tessera {

// In device pixels, as OverlayPainter::paint. `curves` is the painter of the mesh that the overlay is about.
void paintToolOverlay(QPainter& painter, const ToolOverlay& overlay, const OverlayPainter& curves,
                      const PatchMesh& mesh, const ViewTransform& view, const QRectF& visible,
                      double pixelRatio);

}  // namespace tessera
