// Low-discrepancy points with random access: a point depends on its index and seed only. Owen-scrambled pairs of Sobol
// dimensions (Burley, "Practical Hash-based Owen Scrambling", JCGT 2020). See README.md, "Points".
#include "maths.glsl"

uint hash(uint x) {
    // Finalizer of MurmurHash3 (Appleby).
    x ^= x >> 16;
    x *= 0x85ebca6bu;
    x ^= x >> 13;
    x *= 0xc2b2ae35u;
    return x ^ (x >> 16);
}

uint hash_combine(uint seed, uint value) {
    return hash(seed ^ (value * 0x9e3779b9u + 0x7f4a7c15u));
}

// Laine-Karras permutation of bit-reversed values (Burley, listing 1), between two bit reversals: listing 3.
uint owen_scramble(uint x, uint seed) {
    x = bitfieldReverse(x);
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return bitfieldReverse(x);
}

// First two dimensions of the Sobol sequence: a (0, 2)-sequence in base 2.
uvec2 sobol_2d(uint index) {
    uint y = 0u;
    for (uint v = 0x80000000u, i = index; i != 0u; i >>= 1u, v ^= v >> 1u) {
        if ((i & 1u) != 0u) y ^= v;
    }
    return uvec2(bitfieldReverse(index), y);
}

// Point `index` of the scrambled sequence number `pair`, in [0, 1)². Pair 0 keeps its order, so that its prefixes
// are well distributed; the other pairs are shuffled, so that they are not correlated with it.
vec2 sample_2d(uint index, uint pair, uint seed) {
    uint pair_seed = hash_combine(seed, pair);
    uint i = pair == 0u ? index : owen_scramble(index, hash_combine(pair_seed, 2u));
    uvec2 bits = sobol_2d(i);
    bits.x = owen_scramble(bits.x, hash_combine(pair_seed, 0u));
    bits.y = owen_scramble(bits.y, hash_combine(pair_seed, 1u));
    return vec2(bits >> 8u) * (1.0 / 16777216.0);
}

// Unit direction at an angle θ to the unit vector `axis`, given by x = 1 - cos θ, which is exact also for small angles;
// `u` is the azimuth in turns.
vec3 direction_off(vec3 axis, float x, float u) {
    vec3 tangent, bitangent;
    basis_around(axis, tangent, bitangent);
    float sin_theta = sqrt(max(0.0, x * (2.0 - x)));
    float phi = 2.0 * PI * u;
    return sin_theta * (cos(phi) * tangent + sin(phi) * bitangent) + (1.0 - x) * axis;
}

// Unit direction in the hemisphere of `normal` with density cos θ / π, for `u` in [0, 1)². See README.md, "Directions".
vec3 cosine_direction(vec3 normal, vec2 u) {
    return direction_off(normal, 1.0 - sqrt(1.0 - u.x), u.y);
}
