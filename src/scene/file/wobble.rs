//! The `wobble` of an object.

use toml::Spanned;

use super::format::WobbleFile;
use super::source::Source;
use super::values::triple;
use crate::error::Result;
use crate::geometry::Mesh;
use crate::geometry::wave::Wave;
use crate::scene::Wobble;

/// Edges a wave must have at least from crest to crest; with fewer its shape is that of the cuts.
const EDGES: f32 = 4.0;

/// The wobble of one mesh of an object, checked against how finely it is cut.
pub fn wobble(
    source: &Source,
    file: &Spanned<WobbleFile>,
    mesh: &Mesh,
    rate_hz: f32,
) -> Result<Wobble> {
    let keys = file.get_ref();
    let Some(towards) = triple(keys.towards).try_normalize() else {
        let message = "towards has no direction; valid: a vector that is not zero";
        return Err(source.error(&file.span(), message));
    };
    let edges = (0..mesh.triangles.len()).flat_map(|triangle| {
        let [a, b, c] = mesh.corners(triangle);
        [b - a, c - b, a - c]
    });
    let longest = edges.map(|edge| edge.dot(towards).abs()).fold(0.0, f32::max);
    let wavelength = keys.wavelength.0;
    if wavelength < EDGES * longest {
        let message = format!(
            "wavelength = {wavelength} is too short for edges of {longest:.3} m along it; \
             valid: {:.3} or more, or a shape cut more finely",
            EDGES * longest
        );
        return Err(source.error(&file.span(), message));
    }
    let wave = Wave { amplitude: keys.amplitude.0, wavelength, towards };
    Ok(Wobble::new(mesh, wave, keys.period_s.0 * rate_hz))
}
