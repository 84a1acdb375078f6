// The arc tangent, the same on CPU and GPU: Vulkan allows its own 4096 units in the last place.
// Rust twin: geometry/angle.rs.
#define_import_path common::angle

const PI: f32 = 3.14159265358979;

// Angle of (x, y) from the x axis, -pi to pi (Abramowitz & Stegun 4.4.49 inside an octant).
fn angle(y: f32, x: f32) -> f32 {
    let a = abs(x);
    let b = abs(y);
    let t = min(a, b) / max(max(a, b), 1.17549435e-38);
    let s = t * t;
    var p = -0.0040540580;
    p = p * s + 0.0218612288;
    p = p * s - 0.0559098861;
    p = p * s + 0.0964200441;
    p = p * s - 0.1390853351;
    p = p * s + 0.1994653599;
    p = p * s - 0.3332985605;
    p = p * s + 0.9999993329;
    let octant = t * p;
    let quadrant = select(octant, 0.5 * PI - octant, b > a);
    let half_turn = select(quadrant, PI - quadrant, x < 0.0);
    return select(half_turn, -half_turn, y < 0.0);
}
