// Draws the canvas with OpenGL where there is hardware for it.
#pragma once

#include <memory>

#include "app/frame_drawer.h"

namespace tessera {

// What the canvas is drawn with. The processor is the faster one where OpenGL is software too.
struct CanvasRenderer {
    std::unique_ptr<FrameDrawer> drawer;  // null: the CPU renderer
    QString text;                         // "Drawn by …", for the status bar
};

// `force` takes OpenGL even where it is software. For the UI thread, which alone may use the drawer.
CanvasRenderer makeCanvasRenderer(bool force);

}  // namespace tessera
