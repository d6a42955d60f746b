//! What Mitsuba's scattering models have in common: named metals and media, and their defaults
//! [Jakob 2010; Jakob et al. 2022].

use common::Rgb;

use super::Fresnel;
use super::model::{ColorInput, Given, Named, NumberInput};

/// Diffuse reflectance where a scene does not say.
pub(crate) const REFLECTANCE: ColorInput = ColorInput::Constant(Rgb::grey(0.5));
/// Alpha of rough models where a scene does not say.
pub(super) const ROUGHNESS: f64 = 0.1;

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

/// Alpha of the facets; here they are always those of GGX and alike in all directions.
pub(super) fn roughness<G: Given>(given: &mut G) -> Result<NumberInput, G::Error> {
    let facets = given.word("distribution")?.unwrap_or_else(|| "beckmann".to_owned());
    if facets != "ggx" {
        given.warn(&format!("its microfacets follow `ggx` here, not `{facets}`"));
    }
    let alpha = given.number_input("alpha")?;
    if let Some(texture @ NumberInput::Texture { .. }) = alpha {
        return Ok(texture);
    }
    match (given.number("alpha_u")?, given.number("alpha_v")?) {
        (Some(u), Some(v)) => {
            if u != v {
                given.warn("its microfacets are isotropic here: the mean is used");
            }
            Ok((u * v).max(0.0).sqrt().into())
        }
        _ => Ok(alpha.unwrap_or(NumberInput::Constant(ROUGHNESS))),
    }
}

/// What a metal reflects: by its name, or by its index of refraction and extinction coefficient.
pub(super) fn metal<G: Given>(given: &mut G) -> Result<Fresnel, G::Error> {
    let tint = given.color("specular_reflectance")?.unwrap_or(Rgb::WHITE);
    let outside = index(given, "ext_eta", "air")?;
    let name = given.word("material")?;
    if name.as_deref() == Some("none") {
        return Ok(Fresnel::Constant(tint));
    }
    let (eta, k) = if let (Some(eta), Some(k)) = (given.color("eta")?, given.color("k")?) {
        (eta, k)
    } else {
        let name = name.unwrap_or_else(|| "Cu".to_owned());
        let metal = METALS.iter().find(|(known, _, _)| *known == name).ok_or_else(|| {
            let known: Vec<&str> = METALS.iter().map(|(known, _, _)| *known).collect();
            let known = known.join(", ");
            let message =
                format!("unknown metal `{name}`; supported: {known}, none; or give eta and k");
            given.error("material", &message)
        })?;
        (Rgb::from(metal.1), Rgb::from(metal.2))
    };
    Ok(Fresnel::Conductor { eta: eta / outside, k: k / outside, tint })
}

/// An index of refraction, as a number or by name.
pub(super) fn index<G: Given>(
    given: &mut G,
    name: &'static str,
    default: &str,
) -> Result<f64, G::Error> {
    let medium = match given.number_or_name(name)? {
        Some(Named::Number(number)) if number > 0.0 => return Ok(number),
        Some(Named::Number(_)) => {
            let message = "an index of refraction is a positive number (glass is 1.5)";
            return Err(given.error(name, message));
        }
        Some(Named::Name(medium)) => medium,
        None => default.to_owned(),
    };
    let found = INDICES.iter().find(|(known, _)| *known == medium.trim().to_ascii_lowercase());
    found.map(|&(_, index)| index).ok_or_else(|| {
        let known: Vec<&str> = INDICES.iter().map(|(known, _)| *known).collect();
        let message = format!("no medium of that name; known media: {}", known.join(", "));
        given.error(name, &message)
    })
}
