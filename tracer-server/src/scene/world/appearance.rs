//! From the parameters of a material to the model that scatters.

use super::SurfaceMaterial;
use super::paint::Paint;
use crate::bsdf::{
    Bsdf, Dielectric, Fresnel, Ggx, Lambert, Mirror, Plastic, RoughConductor, RoughDielectric,
    RoughPlastic, SMOOTH, deepened,
};
use crate::scene::description::{
    BsdfDescription, ColorInput, Material, NumberInput, SceneDescription,
};

/// A rough boundary between media whose indices differ by less is smooth: it hardly turns light,
/// and a facet could no longer be told from the two directions that it joins.
const EQUAL_MEDIA: f64 = 1e-3;

/// The material with emission in scene units.
pub(super) fn surface(
    description: &SceneDescription,
    material: &Material,
    emission_factor: f64,
) -> SurfaceMaterial {
    SurfaceMaterial {
        name: material.name.clone(),
        bsdf: model(description, material.bsdf),
        paint: paint(material.bsdf),
        one_sided: !material.two_sided && !is_transparent(material.bsdf),
        emission: material.emission * emission_factor,
    }
}

fn is_transparent(bsdf: BsdfDescription) -> bool {
    matches!(bsdf, BsdfDescription::Dielectric { .. } | BsdfDescription::RoughDielectric { .. })
}

/// The textures that a material reads, if any.
fn paint(bsdf: BsdfDescription) -> Option<Paint> {
    let (color, roughness) = match bsdf {
        BsdfDescription::Lambert { reflectance } => (Some(reflectance), None),
        BsdfDescription::Plastic { diffuse, .. } => (Some(diffuse), None),
        BsdfDescription::Conductor { roughness, .. }
        | BsdfDescription::RoughDielectric { roughness, .. } => (None, Some(roughness)),
        BsdfDescription::Mirror { .. } | BsdfDescription::Dielectric { .. } => (None, None),
    };
    let color = color.filter(|input| matches!(input, ColorInput::Texture { .. }));
    let roughness = roughness.filter(|input| matches!(input, NumberInput::Texture { .. }));
    let coat = match bsdf {
        BsdfDescription::Plastic {
            fresnel: Fresnel::Dielectric { eta, .. },
            nonlinear: true,
            ..
        } => Some(eta),
        _ => None,
    };
    (color.is_some() || roughness.is_some()).then_some(Paint { color, roughness, coat })
}

/// True below the limit; a texture is rough everywhere, so that the kind of an event does not
/// depend on the place.
fn is_smooth(roughness: NumberInput) -> bool {
    matches!(roughness, NumberInput::Constant(alpha) if alpha < SMOOTH)
}

fn model(description: &SceneDescription, bsdf: BsdfDescription) -> Bsdf {
    match bsdf {
        BsdfDescription::Lambert { reflectance } => {
            Bsdf::Lambert(Lambert { reflectance: description.mean_color(reflectance) })
        }
        BsdfDescription::Mirror { reflectance } => Bsdf::Mirror(Mirror::new(reflectance)),
        BsdfDescription::Dielectric { eta, reflectance, transmittance } => {
            Bsdf::Dielectric(Dielectric { eta, reflectance, transmittance })
        }
        BsdfDescription::RoughDielectric { eta, reflectance, transmittance, roughness } => {
            let facet = Dielectric { eta, reflectance, transmittance };
            let facets = Ggx::new(description.mean_number(roughness));
            if is_smooth(roughness) || (eta - 1.0).abs() < EQUAL_MEDIA {
                return Bsdf::Dielectric(facet);
            }
            Bsdf::RoughDielectric(RoughDielectric { facet, facets })
        }
        BsdfDescription::Conductor { fresnel, roughness } => {
            let facets = Ggx::new(description.mean_number(roughness));
            if is_smooth(roughness) {
                return Bsdf::Mirror(Mirror { fresnel });
            }
            Bsdf::RoughConductor(RoughConductor { fresnel, facets })
        }
        BsdfDescription::Plastic { diffuse, fresnel, roughness, nonlinear } => {
            let base = description.mean_color(diffuse);
            let base = match fresnel {
                Fresnel::Dielectric { eta, .. } if nonlinear => deepened(base, eta),
                _ => base,
            };
            if is_smooth(roughness.into()) {
                return Bsdf::Plastic(Plastic::new(base, fresnel));
            }
            Bsdf::RoughPlastic(RoughPlastic::new(base, fresnel, Ggx::new(roughness)))
        }
    }
}
