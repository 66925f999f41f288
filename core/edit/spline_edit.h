// Splines changed as functions: channels mixed exactly, or fitted to values at points of the domain.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/edit/colour_fan.h"
#include "core/edit/colour_samples.h"
#include "core/mesh/colour_basis.h"
#include "core/mesh/tps.h"

namespace tessera {

// colour -> matrix * colour + offset, in gamma-encoded sRGB.
struct AffineColour {
    glm::dmat3 matrix{1};
    glm::dvec3 offset{0};

    glm::dvec3 operator()(glm::dvec3 colour) const { return matrix * colour + offset; }
};

// Goes `strength` of the way to the hue and saturation of a colour; luma stays.
AffineColour tinted(glm::dvec3 colour, double strength);

// The spline with its colours changed, whatever its alpha: exact but for the rounding of coefficients. A
// channel gets as many terms as the longest of those that it is mixed of: channels use prefixes of one list
// of centres.
PatchSpline mixed(const PatchSpline& spline, int channels, ColourBasis basis, const AffineColour& change);

// Where a fit looks at colours: sites, the corners first.
struct RefitPoints {
    std::vector<uint8_t> sites;
    std::vector<Barycentric> barycentrics;
    DomainPoints domain;
    std::vector<double> weights;  // in a fit: points on a side count more, since neighbours must agree there

    explicit RefitPoints(std::vector<uint8_t> places);
    size_t size() const { return sites.size(); }

    // The sites in their order.
    static const RefitPoints& all();
    // As many as the terms of a spline need: where it has few, every other site in each direction and its
    // own, without which what they do between the others would not be seen.
    static RefitPoints enoughFor(const PatchSpline& spline);
};

// The least-squares fit of splines with the centres of a given one to values at points of the domain.
// Factorized once, for many fits. A spline without terms or with centres of its own gets sites.
class SplineRefit {
  public:
    // Keeps a reference to `at`.
    explicit SplineRefit(const PatchSpline& like, const RefitPoints& at = RefitPoints::all());
    ~SplineRefit();
    SplineRefit(SplineRefit&&) noexcept;
    SplineRefit& operator=(SplineRefit&&) noexcept;

    // values[c * n + i] of channel c at point i of n, in the basis of the spline. Where the mean deviation at
    // the points is more than kRefitTolerance the spline gets further sites; there is none then where the
    // points are not all of them. Thread-safe.
    std::optional<PatchSpline> fit(std::span<const double> values, int channels) const;

  private:
    struct System;
    std::unique_ptr<System> mSystem;
};

// A change of colours together with what is linear in place.
struct PlacedChange {
    AffineColour change;
    CornerValues corners{};  // added after it

    // The one nearest to a repainting that makes `targets` of a patch's `colours` at some points, near a
    // guess; none where it is farther off than `mean` on the mean of the channels, or `most` anywhere.
    static std::optional<PlacedChange> nearest(const AffineColour& guess, const RefitPoints& at,
                                               std::span<const glm::dvec3> colours,
                                               std::span<const glm::dvec3> targets, double mean, double most);
};

// The places among the sites that are nearest to the default centres, the corners first.
std::vector<uint8_t> usualSites();

constexpr double kRefitTolerance = .5 / 255;

}  // namespace tessera
