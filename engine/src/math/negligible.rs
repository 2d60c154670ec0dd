//! Zero for what is nothing beside the rest of a table.
//!
//! A function of order 60 is 1e-60 of its largest value near the middle. Numbers below the smallest normal one, 1e-38 in single precision,
//! cost a hundred times as much on some processors, and so does every product with them.

/// Share of the largest value below which another counts as nothing: a hundredth of what single precision can tell beside it. *Derived*.
const NEGLIGIBLE: f64 = 1e-9;

/// Sets what is nothing beside the largest value to zero.
pub fn drop_negligible<T: Copy + Default + Into<f64>>(values: &mut [T]) {
    let size = |value: T| Into::<f64>::into(value).abs();
    let least = NEGLIGIBLE * values.iter().map(|&value| size(value)).fold(0.0, f64::max);
    for value in values {
        if size(*value) < least {
            *value = T::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_single_precision_can_tell_stays() {
        let mut values = [-2.0, 1e-7, 1e-8, 1e-9, 1e-40, -1e-300, 0.0];
        drop_negligible(&mut values);
        assert_eq!(values, [-2.0, 1e-7, 1e-8, 0.0, 0.0, 0.0, 0.0]);
        let mut still = [0.0_f32; 3];
        drop_negligible(&mut still);
        assert_eq!(still, [0.0; 3]);
    }
}
