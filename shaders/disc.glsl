// Light from a small disc that reflects evenly.

// 0 where a receiver faces the disc, 1 where it stands square to it.
float squareness(vec3 normal, vec3 from_normal) { return 1.0 - max(-dot(normal, from_normal), 0.0); }

// π / A times the form factor of a disc of area A = π R² at `to_disc` from a receiver, which is `height` above its plane.
// Near the disc it stays finite in two ways, as the receiver turns to it. Facing it the term is cos θ cos θ' / (r² + R²),
// which is exact on its axis (Howell et al., "Thermal Radiation Heat Transfer", configuration factor of a disc). Square to
// it that would darken creases, where a wall takes up half of the floor's sky from however near: there the disc is seen as
// if it sank behind its own surface, by R at contact and R²/r farther off, which leaves the half, to within R over the
// wall's height.
float sinking_disc_term(vec3 to_disc, float height, vec3 normal, float radius2, float square, vec3 from_normal) {
    float depth = square * radius2 * inversesqrt(radius2 + max(dot(to_disc, to_disc), 1e-12));
    vec3 to_sunk = to_disc - depth * normal;
    float distance2 = max(dot(to_sunk, to_sunk), 1e-12);
    float cos_receiver = max(dot(from_normal, to_sunk), 0.0);
    return cos_receiver * (height + depth) / (distance2 * (distance2 + (1.0 - square) * radius2));
}

// The same of a disc whose surface goes on around it.
float disc_term(vec3 position, vec3 normal, float radius2, vec3 from, vec3 from_normal) {
    vec3 to_disc = position - from;
    float height = -dot(normal, to_disc);
    if (height < 0.0) return 0.0;
    return sinking_disc_term(to_disc, height, normal, radius2, squareness(normal, from_normal), from_normal);
}

// Nearer than three times its width a cell is seen point by point.
bool is_near(vec3 apart, float area) { return dot(apart, apart) < 9.0 * area; }
