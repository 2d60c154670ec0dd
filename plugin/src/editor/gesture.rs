//! What a hand does with a parameter.

/// What a hand does with a parameter; hosts record from `Begin` to `End`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gesture {
    /// It takes hold.
    Begin,
    /// It moves to a plain value.
    Set(f32),
    /// It lets go.
    End,
}

/// Moves a parameter to a value in its own unit, in one gesture.
pub fn put(index: usize, value: f32, set: &mut dyn FnMut(usize, Gesture)) {
    for gesture in [Gesture::Begin, Gesture::Set(value), Gesture::End] {
        set(index, gesture);
    }
}
