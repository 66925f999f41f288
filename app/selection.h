// What is selected in a document: patches, control points, curves.
#pragma once

#include <QObject>
#include <vector>

#include "app/change.h"
#include "core/edit/patch_set.h"
#include "core/edit/reshape.h"

namespace tessera {

enum class SelectMode { Replace, Add, Subtract, Intersect };

// `set` with `found` in the way of the mode.
PatchSet combined(const PatchSet& set, const PatchSet& found, SelectMode mode);

// Not a part of the document: no step of the history, and no reason to save. Follows the document's changes
// before others hear of them: what has gone is not selected, the parts of what was split are, and another
// mesh has no selection.
class Selection : public QObject {
    Q_OBJECT

  public:
    const PatchSet& patches() const { return mPatches; }
    const std::vector<ControlPointRef>& points() const { return mPoints; }  // ascending, without repeats
    const std::vector<EdgeId>& curves() const { return mCurves; }           // likewise
    bool empty() const { return mPatches.empty() && mPoints.empty() && mCurves.empty(); }

    // In any order. What is alive and selectable is up to whoever selects.
    void setPatches(PatchSet patches);
    // Points and curves are selected together: the direct-selection tool's.
    void setShape(std::vector<ControlPointRef> points, std::vector<EdgeId> curves);
    void clear();

    // The document's mesh was `before` and is `after` now.
    void follow(const PatchMesh& before, const PatchMesh& after, const Change& change);

  signals:
    void changed();

  private:
    void set(PatchSet patches, std::vector<ControlPointRef> points, std::vector<EdgeId> curves);

    PatchSet mPatches;
    std::vector<ControlPointRef> mPoints;
    std::vector<EdgeId> mCurves;
};

}  // namespace tessera
