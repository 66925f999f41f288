// The colour function of a patch (core/mesh/COLOUR.md).

// All channels at a point of the domain, in the mesh's colour basis.
vec4 evaluateSpline(uint p, vec2 at) {
    countEvaluation();
    const uint first = patches[p].firstTerm, terms = patches[p].terms;
    const uint count = terms & 0xffffu, colourCount = terms >> 16;
    vec4 value = patches[p].polynomial[0] + at.x * patches[p].polynomial[1] + at.y * patches[p].polynomial[2];
    for (uint i = 0u; i < count; ++i) {
        const vec2 off = at - splineTerms[first + i].centre;
        const float q = dot(off, off);
        // phi = s^2 log s = q log2(q) (log 2) / 2, and 0 at 0.
        const float phi = q > 0.0 ? 0.34657359028 * q * log2(q) : 0.0;
        value.x += phi * splineTerms[first + i].alpha[0];
        if (i >= colourCount) continue;
        value.y += phi * splineTerms[first + i].alpha[1];
        value.z += phi * splineTerms[first + i].alpha[2];
        value.w += phi * splineTerms[first + i].alpha[3];
    }
    return value;
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
