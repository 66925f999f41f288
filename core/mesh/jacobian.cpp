// See jacobian.h.
#include "core/mesh/jacobian.h"

#include <algorithm>
#include <cmath>

namespace tessera {

namespace {

constexpr int kFactorial[5] = {1, 1, 2, 6, 24};
constexpr int multinomial(int degree, int i, int j) {
    return kFactorial[degree] / (kFactorial[i] * kFactorial[j] * kFactorial[degree - i - j]);
}

// Derivative control points of the quadratic with exponents (i, j, k): along b - a and along c - a, without
// the factor 3.
struct Derivatives {
    LatticePoint alongV, alongW;
};

Derivatives derivatives(const LatticeTriangle& t, int i, int j) {
    const int k = 2 - i - j;
    const LatticePoint atA = t.p[size_t(controlIndex(i + 1, j, k))];
    return {t.p[size_t(controlIndex(i, j + 1, k))] - atA, t.p[size_t(controlIndex(i, j, k + 1))] - atA};
}

// det J / 9 times multinomial(4; i, j, k), as integers.
std::array<int64_t, 15> scaledCoefficients(const LatticeTriangle& t) {
    Derivatives d[3][3];
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; i + j <= 2; ++j) d[i][j] = derivatives(t, i, j);
    std::array<int64_t, 15> sum{};
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; i + j <= 2; ++j)
            for (int m = 0; m <= 2; ++m)
                for (int n = 0; m + n <= 2; ++n)
                    sum[size_t(quarticIndex(i + m, j + n))] +=
                        multinomial(2, i, j) * multinomial(2, m, n) * cross(d[i][j].alongV, d[m][n].alongW);
    return sum;
}

// Twelve bisections of 4 bits each on coefficients below 2^60.
__extension__ typedef __int128 Wide;

// A quartic over a triangle by coefficients [i][j].
struct Quartic {
    Wide at[5][5];
};

// Both halves of the side between the first two corners, each coefficient times 2^4: (a, m, c) and (m, b, c).
void halve(const Quartic& q, Quartic& first, Quartic& second) {
    Wide level[5][5] = {};
    for (int k = 0; k <= 4; ++k) {
        // Along lines of constant k the polynomial is a univariate one of degree n.
        const int n = 4 - k;
        for (int l = 0; l <= n; ++l) level[0][l] = q.at[n - l][l];
        for (int r = 1; r <= n; ++r)
            for (int l = 0; l + r <= n; ++l) level[r][l] = level[r - 1][l] + level[r - 1][l + 1];
        for (int r = 0; r <= n; ++r) {
            first.at[n - r][r] = level[r][0] * (Wide(1) << (4 - r));
            second.at[r][n - r] = level[r][n - r] * (Wide(1) << (4 - r));
        }
    }
}

Quartic rotated(const Quartic& q) {  // corners (a, b, c) -> (b, c, a)
    Quartic r{};
    for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) r.at[j][4 - i - j] = q.at[i][j];
    return r;
}

bool positive(const Quartic& q, int bisections) {
    bool all = true;
    for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) all = all && q.at[i][j] > 0;
    if (all) return true;
    if (q.at[4][0] <= 0 || q.at[0][4] <= 0 || q.at[0][0] <= 0) return false;  // values at the corners
    if (bisections == 0) return false;
    Quartic first{}, second{};
    halve(q, first, second);
    // Newest-vertex bisection: next is the side opposite the new corner, so that three steps halve every
    // side.
    return positive(rotated(rotated(first)), bisections - 1) && positive(rotated(second), bisections - 1);
}

}  // namespace

std::array<double, 15> jacobianBernstein(const LatticeTriangle& t) {
    const auto scaled = scaledCoefficients(t);
    const auto base = double(cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0)));
    std::array<double, 15> result{};
    for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j) {
            const auto index = size_t(quarticIndex(i, j));
            result[index] = 9.0 * double(scaled[index]) / (multinomial(4, i, j) * base);
        }
    return result;
}

bool certified(const LatticeTriangle& t) {
    const auto scaled = scaledCoefficients(t);
    if (std::all_of(scaled.begin(), scaled.end(), [](int64_t c) { return c > 0; })) return true;
    // Twelve times the coefficients themselves: every multiplicity (1, 4, 6, 12) divides 12.
    Quartic q{};
    for (int i = 0; i <= 4; ++i)
        for (int j = 0; i + j <= 4; ++j)
            q.at[i][j] = Wide(scaled[size_t(quarticIndex(i, j))]) * (12 / multinomial(4, i, j));
    return positive(q, 3 * kMaxCertificateDepth);
}

double minBernstein(const LatticeTriangle& t) {
    if (cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0)) <= 0) return -1;
    const auto coefficients = jacobianBernstein(t);
    return *std::min_element(coefficients.begin(), coefficients.end());
}

std::optional<LatticePoint> certifiedInterior(const LatticeTriangle& t) {
    if (certified(t)) return t.p[kInterior];
    LatticeTriangle trial = t;
    const LatticePoint usual = toLattice(defaultInterior(toPixels(t)));
    trial.p[kInterior] = usual;
    if (certified(trial)) return usual;
    if (cross(t.corner(1) - t.corner(0), t.corner(2) - t.corner(0)) <= 0) return std::nullopt;

    // c_g(x, y) = c0_g + gx_g x + gy_g y around the usual point, in steps of one pixel; maximize the
    // smallest.
    const auto c0 = jacobianBernstein(trial);
    LatticeTriangle alongX = trial, alongY = trial;
    alongX.p[kInterior].x += kLatticePerPixel;
    alongY.p[kInterior].y += kLatticePerPixel;
    const auto cx = jacobianBernstein(alongX), cy = jacobianBernstein(alongY);
    // The optimum lies where three of the planes meet: try each triple (455 of them, tiny and exact enough).
    double best = *std::min_element(c0.begin(), c0.end());
    glm::dvec2 at(0);
    for (size_t a = 0; a < 15; ++a)
        for (size_t b = a + 1; b < 15; ++b)
            for (size_t c = b + 1; c < 15; ++c) {
                const double ax = (cx[a] - c0[a]) - (cx[c] - c0[c]), ay = (cy[a] - c0[a]) - (cy[c] - c0[c]);
                const double bx = (cx[b] - c0[b]) - (cx[c] - c0[c]), by = (cy[b] - c0[b]) - (cy[c] - c0[c]);
                const double determinant = ax * by - ay * bx;
                if (std::abs(determinant) < 1e-14) continue;
                const double ra = c0[c] - c0[a], rb = c0[c] - c0[b];
                const glm::dvec2 point((ra * by - rb * ay) / determinant, (ax * rb - bx * ra) / determinant);
                double smallest = 1e300;
                for (size_t g = 0; g < 15 && smallest > best; ++g)
                    smallest =
                        std::min(smallest, c0[g] + (cx[g] - c0[g]) * point.x + (cy[g] - c0[g]) * point.y);
                if (smallest > best) {
                    best = smallest;
                    at = point;
                }
            }
    trial.p[kInterior] = toLattice(toPixels(usual) + at);
    if (certified(trial)) return trial.p[kInterior];
    return std::nullopt;
}

bool certifiedIfStraight(LatticePoint a, LatticePoint b, LatticePoint c) {
    // Rounding moves the points of the sides by at most r = sqrt(1/2) steps and the default interior point by
    // 3/2 r + r, so that differences of two of them are within 7/2 r of thirds of the sides s and t. Their
    // products are then at least |s x t| / 9 - 7/2 r (|s| + |t|) / 3 - (7/2 r)^2: positive where the height
    // over the longest side, of L steps, is more than 14.9 + 55 / L.
    constexpr double kLeastHeight = .1 * kLatticePerPixel;
    const auto squared = [](LatticePoint d) { return double(d.x) * d.x + double(d.y) * d.y; };
    const auto area2 = double(cross(b - a, c - a));
    const double longest = std::max({squared(b - a), squared(c - b), squared(a - c)});
    return area2 > 0 && area2 * area2 >= kLeastHeight * kLeastHeight * longest;
}

std::optional<LatticePoint> certifiedDefaultInterior(const LatticeTriangle& t) {
    constexpr size_t kRing = 9;
    const auto before = [](LatticePoint a, LatticePoint b) { return a.x != b.x ? a.x < b.x : a.y < b.y; };
    size_t first = 0;
    for (const size_t corner : {size_t{3}, size_t{6}})
        if (before(t.p[corner], t.p[first])) first = corner;
    LatticeTriangle turned = t;
    std::rotate_copy(t.p.begin(), t.p.begin() + std::ptrdiff_t(first), t.p.begin() + kRing, turned.p.begin());
    turned.p[kInterior] = toLattice(defaultInterior(toPixels(turned)));
    return certifiedInterior(turned);
}

}  // namespace tessera
