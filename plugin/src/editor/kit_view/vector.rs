//! Vectors of the world the kit stands in (m): `x` to the drummer's right, `y` up, `z` toward the audience.
//!
//! The axes are left-handed, as those of [`layout`](overhear_engine::layout): nothing here tells a front from
//! a back by the order of its corners.

/// A place or a direction.
pub type V3 = [f32; 3];

pub fn add(a: V3, b: V3) -> V3 {
    std::array::from_fn(|i| a[i] + b[i])
}

pub fn sub(a: V3, b: V3) -> V3 {
    std::array::from_fn(|i| a[i] - b[i])
}

pub fn scale(a: V3, factor: f32) -> V3 {
    a.map(|x| x * factor)
}

pub fn dot(a: V3, b: V3) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn length(a: V3) -> f32 {
    dot(a, a).sqrt()
}

/// Of length one; what has none stays nothing.
pub fn unit(a: V3) -> V3 {
    scale(a, 1.0 / length(a).max(f32::MIN_POSITIVE))
}

/// From `a` (share 0) to `b` (share 1).
pub fn between(a: V3, b: V3, share: f32) -> V3 {
    std::array::from_fn(|i| a[i] + share * (b[i] - a[i]))
}
