//! Are they the right equations? Statistics of beds against independent runs.

mod plane_shear;
