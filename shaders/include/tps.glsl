// The colour function of a patch (core/mesh/COLOUR.md).

// The natural logarithm, to about 1e-7. Splines with large alphas that cancel show what a driver's log2 lacks.
float accurateLog(float q) {
    const int bits = floatBitsToInt(q);
    const int exponent = (bits - 0x3f3504f3) >> 23;  // so that what is left is between the roots of 1/2 and 2
    const float m = intBitsToFloat(bits - (exponent << 23));
    const float s = (m - 1.0) / (m + 1.0), s2 = s * s;
    return 0.69314718056 * float(exponent) +
           2.0 * s * (1.0 + s2 * (0.33333333333 + s2 * (0.2 + s2 * (0.14285714286 + s2 * 0.11111111111))));
}

// The most that a channel of the working space can differ where those of the basis differ so.
float largestInWorking(vec4 c) {
    const float opponent =
        0.57735026919 * c.x + max(0.70710678119 * c.y + 0.40824829046 * c.z, 0.81649658093 * c.z);
    return max(view.opponent != 0u ? opponent : max(c.x, max(c.y, c.z)), c.w);
}

// Where a spline is evaluated: the mean of some points of the domain, and their second moments about it (xx, yy,
// xy), which are 0 for a single point.
struct SplinePlace {
    vec2 at;
    vec3 spread;
};

// All channels, in the mesh's colour basis: the mean over the points of `place`, to second order. The mean of
// phi(|x|) = q log(q) / 2, q = |x|^2, over points with moments C is near phi at q + trace C, plus
// x' C x / (q + trace C); on the centre itself that is exact where the points are equally far from it.
// `unsure` is about what the orders beyond may add.
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
        const vec2 rest = i < terms.others ? loadTermRest(terms.first + i) : vec2(0.0);
        // 0 at 0, where the logarithm is not finite.
        float phi = q > 0.0 ? 0.5 * q * accurateLog(q) : 0.0;
#if SAMPLES > 1
        if (q > 0.0) {
            phi += dot(place.spread, vec3(off * off, 2.0 * off.x * off.y)) / q;
            // The fourth order is phi_xxyy h^4 / 6 for samples at (+-h, +-h), and phi_xxyy 2 / q at most; near the
            // centre the orders do not fall off.
            remainder += largestInWorking(abs(vec4(term.zw, rest))) * (0.0625 + 1.0 * trace / q) / q;
        }
#endif
        value += phi * vec4(term.zw, rest);
    }
    unsure = remainder * trace * trace;
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

// Second moments (vv, ww, vw) of parameters as those of points of the domain (xx, yy, xy).
vec3 domainSpread(vec3 m) {
    return vec3(m.x + m.z + 0.25 * m.y, kDomainHeight * kDomainHeight * m.y, kDomainHeight * (m.z + 0.5 * m.y));
}

vec4 toWorking(vec4 c) {
    if (view.opponent == 0u) return c;
    const float sum = 0.57735026919 * c.x, redBlue = 0.70710678119 * c.y, green = 0.40824829046 * c.z;
    return vec4(sum + redBlue + green, sum - 2.0 * green, sum - redBlue + green, c.w);
}
