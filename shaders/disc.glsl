// Light from a small disc that reflects evenly.

// cos θ cos θ' / (r² + R²): π / A times the form factor of a disc of radius R, which is exact on its axis (Howell et al.,
// "Thermal Radiation Heat Transfer", configuration factor of a disc), and the point's where it is far.
float disc_term(vec3 position, vec3 normal, float radius2, vec3 from, vec3 from_normal) {
    vec3 to_disc = position - from;
    float distance2 = max(dot(to_disc, to_disc), 1e-20);
    float cosines = max(-dot(normal, to_disc), 0.0) * max(dot(from_normal, to_disc), 0.0);
    return cosines / (distance2 * (distance2 + radius2));
}

// Nearer than three times its width a cell is seen point by point.
bool is_near(vec3 apart, float area) { return dot(apart, apart) < 9.0 * area; }
