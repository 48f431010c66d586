//! Draws of several values on their way to a reading each.

use super::reading::Reading;

impl Reading {
    /// Adds draws of several values: a list of numbers for each reading. The lookups belong to the draw, and go to the
    /// first reading.
    pub fn absorb_values(readings: &mut [Self], columns: &[&[f64]], lookups: &[f64]) {
        if let (Some(first), [block, ..]) = (readings.first_mut(), columns) {
            if let Some(ends) = &mut first.ends {
                // For the tests a flight that leaves is beyond all classes; for all else it has the ray's length.
                let marked = ends.marked(block);
                if let Some(tests) = &mut first.background.tests {
                    tests.absorb(&[&marked.beyond], lookups);
                }
                return first.absorb_one(&marked.at_end, lookups);
            }
            if let Some(tests) = &mut first.background.tests {
                tests.absorb(columns, lookups);
            }
        }
        for (index, (reading, column)) in readings.iter_mut().zip(columns).enumerate() {
            reading.absorb_one(column, if index == 0 { lookups } else { &[] });
        }
    }
}
