//! How paths are drawn.

use super::choice::choices;

choices! {
    /// What is drawn of a path.
    #[derive(Default)]
    pub enum Marks {
        /// Its edges, and dots as wanted.
        #[default]
        Lines,
        /// Its vertices only.
        Vertices,
        /// The vertex on the light and the one that the camera sees.
        Ends,
    }
}

choices! {
    /// How paths that cross on the screen are combined.
    #[derive(Default)]
    pub enum Blend {
        /// The newest is on top, and glows on a dark background.
        #[default]
        Newest,
        /// Each counts by its opacity, near ones more, independently of their order.
        Weighted,
        /// They add up like light, for a dark background.
        Add,
    }
}

choices! {
    /// How values are mapped to the colour ramp.
    #[derive(Default)]
    pub enum ColorScale {
        /// Equal ratios are equal steps.
        #[default]
        Log,
        /// Equal differences are equal steps.
        Linear,
    }
}

choices! {
    /// What the colour of a path means, in the order of the shader's codes.
    #[derive(Default)]
    pub enum ColorMode {
        /// The light that the path carries.
        #[default]
        Radiance,
        /// The strategy whose proposal it was.
        Strategy,
        /// Its number of edges, on a colour ramp.
        Length,
        /// Its luminance, on a colour ramp.
        Luminance,
        /// How many paths have come since, on a colour ramp.
        Age,
        /// The kind of each vertex.
        Kind,
        /// Its chain.
        Chain,
        /// Its class, such as LSDE.
        Class,
        /// Nothing: all paths look the same.
        Constant,
        /// The throughput at each vertex, on a colour ramp: what is left of the light on its way
        /// from there to the lens.
        Throughput,
        /// How many steps its chain stayed, on a colour ramp.
        Dwell,
        /// The probability with which it was accepted, on a colour ramp.
        Acceptance,
    }
}

impl ColorMode {
    /// True when the colours come from the ramp, and the scale says how.
    pub fn has_scale(self) -> bool {
        matches!(self, Self::Length | Self::Luminance | Self::Throughput)
    }
}
