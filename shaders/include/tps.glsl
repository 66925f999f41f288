// The colour function of a patch (core/mesh/COLOUR.md).

// Where a spline is evaluated: the mean of some points of the domain, and their second moments about it (xx, yy,
// xy), which are 0 for a single point.
struct SplinePlace {
    vec2 at;
    vec3 spread;
};

// All channels, in the mesh's colour basis: the mean over the points of `place`, to second order. The mean of
// phi(|x|) = q log(q) / 2, q = |x|^2, over points with moments C is near phi at q + trace C, plus
// x' C x / (q + trace C); on the centre itself that is exact where the points are equally far from it.
// `unsure` is about what the orders beyond may add, in channels 0 and 1.
vec4 evaluateSpline(uint p, SplinePlace place, out float unsure) {
    countEvaluation();
    const SplineTerms terms = loadTerms(p);
    const vec2 at = place.at;
    const float trace = place.spread.x + place.spread.y;
    vec4 value = loadPolynomial(p, 0u) + at.x * loadPolynomial(p, 1u) + at.y * loadPolynomial(p, 2u);
    float remainder = 0.0;
    for (uint i = 0u; i < terms.count; ++i) {
        const vec4 term = loadTerm(terms.first + i);
        const vec2 off = at - term.xy;
        const float q = dot(off, off) + trace;
        // 0 at 0, where log2 is not finite.
        float phi = q > 0.0 ? 0.34657359028 * q * log2(q) : 0.0;
#if SAMPLES > 1
        const vec3 squares = vec3(off * off, 2.0 * off.x * off.y);
        if (q > 0.0) {
            phi += dot(place.spread, squares) / q;
            // phi_xxyy is 2 / q at most, the fourth order h^4 / 6 of that for samples at (+-h, +-h).
            remainder += max(abs(term.z), abs(term.w)) / q;
        }
#endif
        value.xy += phi * term.zw;
        if (i < terms.others) value.zw += phi * loadTermRest(terms.first + i);
    }
    unsure = remainder * trace * trace / 12.0;
    return value;
}

vec4 evaluateSpline(uint p, vec2 at) {
    float unsure;
    return evaluateSpline(p, SplinePlace(at, vec3(0.0)), unsure);
}

const float kDomainHeight = 0.86602540378;

vec2 domainPoint(vec2 vw) {
    return vec2(vw.x + 0.5 * vw.y, kDomainHeight * vw.y);
}

vec4 toWorking(vec4 c) {
    if (view.opponent == 0u) return c;
    const float sum = 0.57735026919 * c.x, redBlue = 0.70710678119 * c.y, green = 0.40824829046 * c.z;
    return vec4(sum + redBlue + green, sum - 2.0 * green, sum - redBlue + green, c.w);
}
