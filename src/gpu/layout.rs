//! Tests hold every Rust struct that shaders read against naga's layout of its WGSL twin.

use super::Shaders;

/// Check size and member offsets of a WGSL struct as composed into an entry file.
///
/// # Panics
/// Where anything differs: this is for tests.
pub fn check(file: &str, structure: &str, size: usize, members: &[(&str, usize)]) {
    let mut shaders = Shaders::new(None).unwrap();
    let defines = [("RECORD_FULL", 1), ("INDEX_SURFACE", 1), ("REFLECTOR_CUBE", 1)];
    let module = shaders.module(file, &defines).unwrap();
    let named = |name: &Option<String>| {
        name.as_deref().is_some_and(|n| n.split("X_naga_oil").next() == Some(structure))
    };
    let found = module.types.iter().find(|(_, t)| named(&t.name));
    let Some((_, naga::Type { inner: naga::TypeInner::Struct { members: theirs, span }, .. })) =
        found
    else {
        panic!("no struct {structure} in shaders/{file}");
    };
    assert_eq!(size, *span as usize, "size of {structure}");
    assert_eq!(members.len(), theirs.len(), "number of members of {structure}");
    for ((name, offset), member) in members.iter().zip(theirs) {
        assert_eq!(*offset, member.offset as usize, "offset of {structure}.{name}");
    }
}

/// [`check`] of a Rust struct, its members named in order.
macro_rules! assert_layout {
    ($file:literal, $wgsl:literal, $rust:ty, $($member:ident),+ $(,)?) => {
        crate::gpu::layout::check(
            $file,
            $wgsl,
            size_of::<$rust>(),
            &[$((stringify!($member), std::mem::offset_of!($rust, $member))),+],
        )
    };
}
pub(crate) use assert_layout;
