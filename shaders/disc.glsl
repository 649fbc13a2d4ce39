// Light from a small disc that reflects evenly.

// π / A times the form factor of a disc of area A = π R² for a receiver at `from`, near which it stays finite in two ways.
// Facing the disc the term is cos θ cos θ' / (r² + R²), which is exact on its axis (Howell et al., "Thermal Radiation Heat
// Transfer", configuration factor of a disc). Square to it that would darken creases, where a wall takes up half of the
// floor's sky from however near: there the disc is seen as if it sank behind its surface, by R at contact and R²/r farther
// off.
float disc_term(vec3 position, vec3 normal, float radius2, vec3 from, vec3 from_normal) {
    vec3 to_disc = position - from;
    float height = -dot(normal, to_disc);
    if (height < 0.0) return 0.0;
    float square = 1.0 - max(-dot(normal, from_normal), 0.0);
    float depth = square * radius2 * inversesqrt(radius2 + max(dot(to_disc, to_disc), 1e-20));
    vec3 to_sunk = to_disc - depth * normal;
    float distance2 = max(dot(to_sunk, to_sunk), 1e-20);
    float cosines = max(dot(from_normal, to_sunk), 0.0) * (height + depth);
    return cosines / (distance2 * (distance2 + (1.0 - square) * radius2));
}

// Nearer than three times its width a cell is seen point by point.
bool is_near(vec3 apart, float area) { return dot(apart, apart) < 9.0 * area; }
