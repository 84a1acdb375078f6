//! Traces: "a concatenation of reflector IDs hit by the ray after it left the camera" (Martin & Popescu 2004,
//! section 4.2).

use crate::scene::{Ids, ObjectId, Scene};

/// The reflectors that rays meet, in order; each trace is another projection of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trace {
    /// As in [`Ids`].
    pub packed: u32,
    /// Reflectors met.
    pub order: u32,
    /// The one the eye sees, and the one that shows the vertices.
    pub first: ObjectId,
    pub last: ObjectId,
}

impl Trace {
    /// Of one reflector.
    pub fn of(scene: &Scene, first: ObjectId) -> Trace {
        let packed = Ids::extended(0, 0, rank_of(scene, first));
        Trace { packed, order: 1, first, last: first }
    }

    /// With one more.
    pub fn on(self, scene: &Scene, last: ObjectId) -> Trace {
        let packed = Ids::extended(self.packed, self.order, rank_of(scene, last));
        Trace { packed, order: self.order + 1, last, ..self }
    }
}

/// A reflector's rank among the scene's.
fn rank_of(scene: &Scene, object: ObjectId) -> u32 {
    scene.reflectors().iter().take_while(|&&mirror| mirror != object).count() as u32
}
