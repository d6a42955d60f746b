//! Scattering models, as far as the tracer has them.

use common::Rgb;

use super::document::Element;
use super::texture::Textures;
use crate::bsdf::Fresnel;
use crate::scene::description::{BsdfDescription, ColorInput, Material, NumberInput};
use crate::scene::reading::diagnostic::LoadError;

/// The deepest that models may be nested in one another.
const MAX_NESTING: usize = 16;
/// Diffuse reflectance where a scene does not say.
const DEFAULT_REFLECTANCE: f64 = 0.5;

/// Alpha of rough models where a scene does not say.
const DEFAULT_ROUGHNESS: f64 = 0.1;

/// Metals that scenes refer to by name: index of refraction and extinction coefficient at about
/// 610, 550 and 465 nm [Johnson and Christy 1972; Rakic 1995].
const METALS: &[(&str, [f64; 3], [f64; 3])] = &[
    ("Ag", [0.155, 0.117, 0.138], [4.828, 3.122, 2.147]),
    ("Al", [1.657, 0.880, 0.521], [9.224, 6.270, 4.837]),
    ("Au", [0.143, 0.375, 1.442], [3.983, 2.386, 1.603]),
    ("Cr", [4.370, 2.917, 1.655], [5.206, 4.231, 3.754]),
    ("Cu", [0.200, 0.924, 1.102], [3.912, 2.452, 2.142]),
];

/// Indices of refraction that scenes refer to by name.
const INDICES: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.333),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.47),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.575),
    ("diamond", 2.419),
];

/// A model as it is read, before it becomes a material.
#[derive(Clone, Copy, Debug)]
struct Model {
    bsdf: BsdfDescription,
    two_sided: bool,
}

/// Reads a `bsdf`; `None` for a surface that nothing sees.
pub(super) fn read(
    element: Element<'_>,
    textures: &mut Textures,
) -> Result<Option<Material>, LoadError> {
    let model = Reader { textures }.model(element, 0)?;
    Ok(model.map(|Model { bsdf, two_sided }| Material {
        two_sided,
        ..Material::new(element.label(), bsdf)
    }))
}

/// The material of a shape without a `bsdf`.
pub(super) fn default_material(emits: bool) -> Material {
    let reflectance = if emits { Rgb::BLACK } else { Rgb::grey(DEFAULT_REFLECTANCE) };
    let bsdf = BsdfDescription::Lambert { reflectance: reflectance.into() };
    Material { two_sided: false, ..Material::new("(default)", bsdf) }
}

struct Reader<'t> {
    textures: &'t mut Textures,
}

impl Reader<'_> {
    fn model(&mut self, element: Element<'_>, depth: usize) -> Result<Option<Model>, LoadError> {
        if depth > MAX_NESTING {
            let message = format!("nested more than {MAX_NESTING} deep, or within itself");
            return Err(element.error(message));
        }
        let one_sided = |bsdf| Ok(Some(Model { bsdf, two_sided: false }));
        match element.plugin()?.as_str() {
            "diffuse" | "roughdiffuse" => {
                let reflectance = self.color_input(element, "reflectance")?;
                one_sided(BsdfDescription::Lambert { reflectance })
            }
            "dielectric" | "thindielectric" => one_sided(dielectric(element)?),
            "roughdielectric" => {
                let roughness = self.roughness(element)?;
                one_sided(rough(dielectric(element)?, roughness))
            }
            "conductor" => {
                let roughness = 0.0.into();
                one_sided(BsdfDescription::Conductor { fresnel: metal(element)?, roughness })
            }
            "roughconductor" => {
                let roughness = self.roughness(element)?;
                one_sided(BsdfDescription::Conductor { fresnel: metal(element)?, roughness })
            }
            "plastic" => one_sided(self.plastic(element, 0.0)?),
            "roughplastic" => {
                let roughness = match self.roughness(element)? {
                    NumberInput::Constant(roughness) => roughness,
                    NumberInput::Texture { .. } => {
                        self.tell(element, "the roughness of a coat reads no texture: 0.1 is used");
                        DEFAULT_ROUGHNESS
                    }
                };
                one_sided(self.plastic(element, roughness)?)
            }
            "twosided" => {
                let inner = self.nested(element, depth)?;
                Ok(inner.map(|model| Model { two_sided: true, ..model }))
            }
            "mask" | "bumpmap" | "normalmap" | "bump" => {
                self.tell(element, "has no effect; what is nested in it has");
                self.nested(element, depth)
            }
            "blendbsdf" | "mixturebsdf" => {
                self.tell(element, "only the first of the models in it has an effect");
                self.nested(element, depth)
            }
            "null" => Ok(None),
            _ => Err(element.error(
                "no such scattering model here; those known: diffuse, dielectric, conductor, \
                 plastic, their rough forms, thindielectric, twosided, mask, bumpmap, normalmap, \
                 blendbsdf, mixturebsdf, null",
            )),
        }
    }

    fn tell(&mut self, element: Element<'_>, message: &str) {
        self.textures.warnings.push(element.warning(message));
    }

    fn nested(&mut self, element: Element<'_>, depth: usize) -> Result<Option<Model>, LoadError> {
        let inner = element.objects("bsdf")?;
        let first = inner
            .first()
            .ok_or_else(|| element.error("a `<bsdf>` must be nested in it, or a `<ref>` to one"))?;
        self.model(*first, depth + 1)
    }

    /// Alpha of the facets; here they are always those of GGX and alike in all directions.
    fn roughness(&mut self, element: Element<'_>) -> Result<NumberInput, LoadError> {
        let facets = element.string("distribution")?.unwrap_or_else(|| "beckmann".to_owned());
        if facets != "ggx" {
            self.tell(element, &format!("its facets are those of `ggx` here, not of `{facets}`"));
        }
        if let Some(texture) = element.property("alpha")?.filter(|value| value.tag() == "texture") {
            return Ok(match self.textures.input(texture)? {
                ColorInput::Texture { texture, .. } => {
                    NumberInput::Texture { texture, factor: 1.0 }
                }
                ColorInput::Constant(color) => color.luminance().into(),
            });
        }
        let along = [element.number("alpha_u")?, element.number("alpha_v")?];
        let alpha = match along {
            [Some(u), Some(v)] => {
                if u != v {
                    self.tell(element, "its facets are alike in all directions: the mean is used");
                }
                (u * v).max(0.0).sqrt()
            }
            _ => element.number("alpha")?.unwrap_or(DEFAULT_ROUGHNESS),
        };
        Ok(alpha.into())
    }

    fn plastic(
        &mut self,
        element: Element<'_>,
        roughness: f64,
    ) -> Result<BsdfDescription, LoadError> {
        let eta = index(element, "int_ior", "polypropylene")? / index(element, "ext_ior", "air")?;
        let tint = element.color("specular_reflectance")?.unwrap_or(Rgb::WHITE);
        Ok(BsdfDescription::Plastic {
            diffuse: self.color_input(element, "diffuse_reflectance")?,
            fresnel: Fresnel::Dielectric { eta, tint },
            roughness,
            nonlinear: element.flag("nonlinear")?,
        })
    }

    /// A colour or a texture; the default of diffuse surfaces where it is absent.
    fn color_input(&mut self, element: Element<'_>, name: &str) -> Result<ColorInput, LoadError> {
        match element.property(name)? {
            None => Ok(Rgb::grey(DEFAULT_REFLECTANCE).into()),
            Some(value) if value.tag() == "texture" => self.textures.input(value),
            Some(value) => value.as_color().map(ColorInput::from),
        }
    }
}

fn dielectric(element: Element<'_>) -> Result<BsdfDescription, LoadError> {
    let inside = index(element, "int_ior", "bk7")?;
    let outside = index(element, "ext_ior", "air")?;
    Ok(BsdfDescription::Dielectric {
        eta: inside / outside,
        reflectance: element.color("specular_reflectance")?.unwrap_or(Rgb::WHITE),
        transmittance: element.color("specular_transmittance")?.unwrap_or(Rgb::WHITE),
    })
}

/// The same boundary with facets.
fn rough(smooth: BsdfDescription, roughness: NumberInput) -> BsdfDescription {
    match smooth {
        BsdfDescription::Dielectric { eta, reflectance, transmittance } => {
            BsdfDescription::RoughDielectric { eta, reflectance, transmittance, roughness }
        }
        other => other,
    }
}

/// What a metal reflects: by its name, or by its index of refraction and extinction coefficient.
fn metal(element: Element<'_>) -> Result<Fresnel, LoadError> {
    let tint = element.color("specular_reflectance")?.unwrap_or(Rgb::WHITE);
    let outside = index(element, "ext_eta", "air")?;
    let name = element.string("material")?;
    if name.as_deref() == Some("none") {
        return Ok(Fresnel::Constant(tint));
    }
    let (eta, k) = if let (Some(eta), Some(k)) = (element.color("eta")?, element.color("k")?) {
        (eta, k)
    } else {
        let name = name.unwrap_or_else(|| "Cu".to_owned());
        let metal = METALS.iter().find(|(known, _, _)| *known == name).ok_or_else(|| {
            let known: Vec<&str> = METALS.iter().map(|(known, _, _)| *known).collect();
            let known = known.join(", ");
            element.error(format!(
                "no metal `{name}` here; those known: {known}, none; or give eta and k"
            ))
        })?;
        (Rgb::from(metal.1), Rgb::from(metal.2))
    };
    Ok(Fresnel::Conductor { eta: eta / outside, k: k / outside, tint })
}

/// An index of refraction, as a number or by name.
fn index(element: Element<'_>, name: &str, default: &str) -> Result<f64, LoadError> {
    let material = match element.property(name)? {
        Some(value) if value.tag() != "string" => {
            let number = element.number(name)?;
            return number.filter(|&n| n > 0.0).ok_or_else(|| {
                value.error("an index of refraction is a positive number (glass is 1.5)")
            });
        }
        Some(value) => value.needed("value")?,
        None => default.to_owned(),
    };
    let found = INDICES.iter().find(|(known, _)| *known == material.trim().to_ascii_lowercase());
    found.map(|&(_, index)| index).ok_or_else(|| {
        let known: Vec<&str> = INDICES.iter().map(|(known, _)| *known).collect();
        let message = format!("{name}: no medium of that name; those known: {}", known.join(", "));
        element.error(message)
    })
}
