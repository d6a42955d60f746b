//! How light scatters at a point of a surface. Local: knows no scene and no path.
//!
//! To add a model: write its file with an `impl Scatter` of what scatters and an `impl Model` of what
//! its author writes, declare the module, and add a line to the list in `models!` below: scene files,
//! checks, tables and the laws in `laws.rs` follow from it. `docs/EXTEND.md` walks through it.

mod conductor;
mod dielectric;
mod fresnel;
mod ggx;
mod lambert;
mod local;
mod mirror;
pub(crate) mod mitsuba;
mod model;
mod plastic;

#[cfg(test)]
mod laws;
#[cfg(test)]
mod model_laws;

use common::{Event, Rgb};
use glam::DVec3;

use crate::math::Rng;
pub use conductor::{ConductorDescription, RoughConductor};
pub use dielectric::{Dielectric, DielectricDescription, RoughDielectric};
pub use fresnel::Fresnel;
pub use ggx::Ggx;
pub use lambert::{Lambert, LambertDescription};
pub use local::Local;
pub use mirror::{Mirror, MirrorDescription};
pub use model::{ColorInput, Given, Inputs, Model, Named, NumberInput, Parameter, Range, Value};
pub use plastic::{Plastic, PlasticDescription, RoughPlastic};

/// Everything a path needs of one scattering vertex, given both neighbours and the event.
///
/// One colour and a few scalars: the vertex's contribution to the path is `color` times a scalar
/// that depends only on how the vertex was made. With `f` the scattering function and `w_l`, `w_e`
/// the directions to the neighbours on the light and on the eye side:
///
/// - `color * connection = f(w_l, w_e)` (zero for a Dirac event; [`Local`] adds a factor),
/// - `color * light_weight = f |cos w_e| / light_pdf`: made by a walk from the light,
/// - `color * eye_weight = f |cos w_l| / eye_pdf`: made by a walk from the eye.
///
/// For a Dirac event the pdfs are the event's probability and the quotients are taken with the
/// Dirac delta cancelled; only the eye side carries the squared ratio of refractive indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scattering {
    /// Reflectance or transmittance.
    pub color: Rgb,
    /// Scalar for an explicit connection, in 1/sr.
    pub connection: f64,
    /// Scalar for a walk from the light.
    pub light_weight: f64,
    /// Scalar for a walk from the eye.
    pub eye_weight: f64,
    /// Density of `w_e` given `w_l`: per solid angle, or a probability for a Dirac event.
    pub light_pdf: f64,
    /// Density of `w_l` given `w_e`: per solid angle, or a probability for a Dirac event.
    pub eye_pdf: f64,
}

/// What a scattering model must provide. All directions are unit vectors that point away from the
/// surface; `n` is the unit normal on the front side.
pub trait Scatter {
    /// A word or two for tables.
    const NAME: &'static str;
    /// True when some of its events are Dirac ones.
    const HAS_DIRAC_LOBE: bool = false;
    /// True when light passes through it.
    const IS_TRANSPARENT: bool = false;

    /// Makes of uniform numbers an event (of the first) and the direction the walk goes on (of the
    /// other two), given the direction `w` it came from. `None` when the walk is absorbed.
    fn sample(&self, n: DVec3, w: DVec3, u: [f64; 3]) -> Option<(DVec3, Event)>;

    /// Numbers from which [`Scatter::sample`] would have made `w_out` and `event`.
    ///
    /// Where many numbers would have, as for a discrete choice, `rng` draws one of them uniformly:
    /// numbers that were uniform before they made a sample are uniform again.
    fn invert(&self, n: DVec3, w: DVec3, w_out: DVec3, event: Event, rng: &mut Rng) -> [f64; 3];

    /// All values of the vertex; `None` where they are zero.
    fn evaluate(&self, n: DVec3, w_l: DVec3, w_e: DVec3, event: Event) -> Option<Scattering>;

    /// The only direction in which the Dirac `event` continues from `w`; `None` when it cannot
    /// happen there (total internal reflection, or no such lobe).
    fn specular_direction(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3>;

    /// The event with which a vertex can be joined to any other by an explicit connection.
    fn connectable(&self) -> Option<Event>;

    /// About how much of the light is scattered, at most 1: for Russian roulette.
    fn albedo(&self) -> f64;

    /// The colour by which people would know it.
    fn preview_color(&self) -> Rgb;
}

/// One entry of the table of models.
#[derive(Clone, Copy, Debug)]
pub struct ModelKind {
    /// The name in the project's own scene files.
    pub name: &'static str,
    /// What it is, for people.
    pub about: &'static str,
    /// What the project's own scene files may say of it.
    pub parameters: &'static [Parameter],
    /// What Mitsuba calls it, and models that come near it.
    pub plugins: &'static [&'static str],
}

/// Makes of one list the enum of what authors describe, the enum of what scatters, the table of their
/// kinds, and every `match` on them.
macro_rules! models {
    ($(
        $(#[$doc:meta])*
        $model:ident($description:ty) => $($form:ident($scatter:ty)),+;
    )*) => {
        /// A scattering model as its author describes it.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum BsdfDescription {
            $($(#[$doc])* $model($description),)*
        }

        /// A scattering model that is built, with its parameters.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Bsdf {
            $($(
                #[doc = concat!("See [`", stringify!($scatter), "`].")]
                $form($scatter),
            )+)*
        }

        /// All models that an author may ask for.
        pub const MODELS: &[ModelKind] = &[$(ModelKind {
            name: <$description as Model>::NAME,
            about: <$description as Model>::ABOUT,
            parameters: <$description as Model>::PARAMETERS,
            plugins: <$description as Model>::PLUGINS,
        }),*];

        $(impl From<$description> for BsdfDescription {
            fn from(description: $description) -> Self {
                Self::$model(description)
            }
        })*

        impl BsdfDescription {
            /// Reads the model of that name in the project's own scene files; `None` where there is
            /// none.
            pub fn read<G: Given>(name: &str, given: &mut G) -> Option<Result<Self, G::Error>> {
                $(if name == <$description as Model>::NAME {
                    return Some(<$description as Model>::read(given).map(Self::$model));
                })*
                None
            }

            /// Reads what Mitsuba calls by that name; `None` where there is no such model.
            pub fn read_plugin<G: Given>(
                plugin: &str,
                given: &mut G,
            ) -> Option<Result<Self, G::Error>> {
                $(if <$description as Model>::PLUGINS.contains(&plugin) {
                    let read = <$description as Model>::read_plugin(plugin, given);
                    return Some(read.map(Self::$model));
                })*
                None
            }

            /// The name in the project's own scene files.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$model(_) => <$description as Model>::NAME,)*
                }
            }

            /// Shows every parameter under its name.
            pub fn parameters(&mut self, see: &mut dyn FnMut(&'static str, Value<'_>)) {
                match self {
                    $(Self::$model(model) => model.parameters(see),)*
                }
            }

            /// As [`Model::build`].
            pub fn build(&self, inputs: &impl Inputs) -> Bsdf {
                match self {
                    $(Self::$model(model) => model.build(inputs),)*
                }
            }

            /// As [`Model::rebuild`].
            pub fn rebuild(&self, built: &Bsdf, inputs: &impl Inputs) -> Bsdf {
                match self {
                    $(Self::$model(model) => model.rebuild(built, inputs),)*
                }
            }

            /// As [`Model::inside_out`].
            pub fn inside_out(&self) -> Option<Self> {
                match self {
                    $(Self::$model(model) => model.inside_out().map(Self::$model),)*
                }
            }
        }

        impl Bsdf {
            /// A word or two for tables.
            pub fn name(&self) -> &'static str {
                match self {
                    $($(Self::$form(_) => <$scatter as Scatter>::NAME,)+)*
                }
            }

            /// True when some of its events are Dirac ones.
            pub fn has_dirac_lobe(&self) -> bool {
                match self {
                    $($(Self::$form(_) => <$scatter as Scatter>::HAS_DIRAC_LOBE,)+)*
                }
            }

            /// True when light passes through it.
            pub fn is_transparent(&self) -> bool {
                match self {
                    $($(Self::$form(_) => <$scatter as Scatter>::IS_TRANSPARENT,)+)*
                }
            }

            /// As [`Scatter::sample`].
            #[inline]
            pub fn sample(&self, n: DVec3, w: DVec3, u: [f64; 3]) -> Option<(DVec3, Event)> {
                match self {
                    $($(Self::$form(model) => model.sample(n, w, u),)+)*
                }
            }

            /// As [`Scatter::invert`].
            pub fn invert(
                &self,
                n: DVec3,
                w: DVec3,
                w_out: DVec3,
                event: Event,
                rng: &mut Rng,
            ) -> [f64; 3] {
                match self {
                    $($(Self::$form(model) => model.invert(n, w, w_out, event, rng),)+)*
                }
            }

            /// As [`Scatter::evaluate`].
            #[inline]
            pub fn evaluate(
                &self,
                n: DVec3,
                w_l: DVec3,
                w_e: DVec3,
                event: Event,
            ) -> Option<Scattering> {
                match self {
                    $($(Self::$form(model) => model.evaluate(n, w_l, w_e, event),)+)*
                }
            }

            /// As [`Scatter::specular_direction`].
            #[inline]
            pub fn specular_direction(&self, n: DVec3, w: DVec3, event: Event) -> Option<DVec3> {
                match self {
                    $($(Self::$form(model) => model.specular_direction(n, w, event),)+)*
                }
            }

            /// As [`Scatter::connectable`].
            #[inline]
            pub fn connectable(&self) -> Option<Event> {
                match self {
                    $($(Self::$form(model) => model.connectable(),)+)*
                }
            }

            /// As [`Scatter::albedo`].
            #[inline]
            pub fn albedo(&self) -> f64 {
                match self {
                    $($(Self::$form(model) => model.albedo(),)+)*
                }
            }

            /// The colour by which people would know it.
            pub fn preview_color(&self) -> Rgb {
                match self {
                    $($(Self::$form(model) => model.preview_color(),)+)*
                }
            }
        }

        /// Every model that scatters, put to the laws with parameters that matter.
        #[cfg(test)]
        fn specimens() -> Vec<laws::Specimen> {
            let mut all = Vec::new();
            $($(all.extend(laws::specimens_of(Bsdf::$form));)+)*
            all
        }
    };
}

models! {
    /// Ideal diffuse reflection.
    Lambert(LambertDescription) => Lambert(Lambert);
    /// An ideal mirror.
    Mirror(MirrorDescription) => Mirror(Mirror);
    /// A boundary between two transparent media.
    Dielectric(DielectricDescription) => Dielectric(Dielectric), RoughDielectric(RoughDielectric);
    /// A metal.
    Conductor(ConductorDescription) => RoughConductor(RoughConductor);
    /// Diffuse paint under a transparent coat.
    Plastic(PlasticDescription) => Plastic(Plastic), RoughPlastic(RoughPlastic);
}

/// Mirror image of `w` in the plane with normal `n`.
#[inline]
pub(crate) fn reflect(n: DVec3, w: DVec3) -> DVec3 {
    2.0 * n.dot(w) * n - w
}
