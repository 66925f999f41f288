// What a listener to a document must look at again.
#pragma once

#include "core/edit/touched.h"

namespace tessera {

// One signal carries all that one step changed, so that no listener sees half of it.
struct Change {
    Touched touched = {};     // of the mesh; of a preview: since the preview before it
    bool preview = false;     // of an open EditSession: another one, a commit or the start state will follow
    bool replaced = false;    // another mesh altogether, with report and settings: no id means what it did
    bool selections = false;  // the named selections
    bool photo = false;       // the photo has been found, or is another one
    bool saved = false;       // the path or the modified state

    bool mesh() const { return replaced || !touched.empty(); }
};

}  // namespace tessera
