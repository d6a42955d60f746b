//! What an MTL material means: the nearest model that Lvis has, and a warning where it is only near.

use common::Rgb;

use super::description::{BsdfDescription, Material};

/// The statements of one MTL material, as far as they matter here.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MtlEntry {
    /// `newmtl`.
    pub(super) name: String,
    /// `Kd`.
    pub(super) diffuse: Option<Rgb>,
    /// `Ks`.
    pub(super) specular: Option<Rgb>,
    /// `Ke`.
    pub(super) emission: Option<Rgb>,
    /// `Tf`.
    pub(super) filter: Option<Rgb>,
    /// `d`, or one less `Tr`: 1 is opaque.
    pub(super) opacity: Option<f64>,
    /// `Ni`.
    pub(super) eta: Option<f64>,
    /// `Ns`, a Phong exponent.
    pub(super) shininess: Option<f64>,
    /// `Pr`, in [0, 1].
    pub(super) roughness: Option<f64>,
    /// `Pm`, in [0, 1].
    pub(super) metallic: Option<f64>,
    /// `illum`.
    pub(super) illumination: Option<u8>,
    /// Mean of `map_Kd`, or `Err` when the image could not be read.
    pub(super) diffuse_map: Option<Result<Rgb, String>>,
    /// Mean of `map_Ke`, or `Err` when the image could not be read.
    pub(super) emission_map: Option<Result<Rgb, String>>,
}

/// Glossy lobes narrower than this roughness are nearer to a mirror than to matt paint.
const MIRROR_ROUGHNESS: f64 = 0.1;
/// What a surface reflects at most when lobes that are not modelled are added to its diffuse one.
const MAX_ALBEDO: f64 = 0.95;
/// A surface more transparent than this is taken for glass, otherwise for opaque.
const GLASS_OPACITY: f64 = 0.5;
/// A transmission filter darker than this is taken for the share absorbed.
const DARK_FILTER: f64 = 0.5;
/// The index of refraction of glass, where none is given.
const GLASS: f64 = 1.5;
/// The grey of a surface whose colour is not known.
pub(super) const UNKNOWN_GREY: f64 = 0.5;

impl MtlEntry {
    /// The nearest material, and what is not as the file says.
    pub(super) fn to_material(&self) -> (Material, Vec<String>) {
        let mut notes = Vec::new();
        let emission = self.radiance(&mut notes);
        let bsdf = if self.is_glass(&mut notes) {
            self.glass(&mut notes)
        } else {
            self.opaque(emission, &mut notes)
        };
        (Material { emission, ..Material::new(&self.name, bsdf) }, notes)
    }

    fn radiance(&self, notes: &mut Vec<String>) -> Rgb {
        match &self.emission_map {
            None => self.emission.unwrap_or(Rgb::BLACK),
            Some(Ok(mean)) => {
                notes.push("map_Ke: emission textures are not modelled; its mean is used".into());
                // Exporters that write only the map mean it at full strength.
                self.emission.filter(|ke| !ke.is_black()).unwrap_or(Rgb::WHITE) * *mean
            }
            Some(Err(error)) => {
                notes.push(format!("map_Ke: {error}; Ke is used without it"));
                self.emission.unwrap_or(Rgb::BLACK)
            }
        }
    }

    /// Glass by its illumination model, or because light passes.
    fn is_glass(&self, notes: &mut Vec<String>) -> bool {
        if matches!(self.illumination, Some(4 | 6 | 7 | 9)) {
            return true;
        }
        let opacity = self.opacity.unwrap_or(1.0);
        if opacity < GLASS_OPACITY {
            return true;
        }
        let filtered = self.filter.is_some_and(|tf| !tf.is_black());
        if self.illumination.is_none() && filtered && self.eta.is_some_and(|eta| eta > 1.0) {
            return true;
        }
        if opacity < 1.0 {
            notes.push(format!("partial transparency is not modelled; d {opacity} becomes opaque"));
        }
        false
    }

    fn glass(&self, notes: &mut Vec<String>) -> BsdfDescription {
        let eta = match self.eta {
            Some(eta) if eta > 0.0 => eta,
            _ => {
                notes.push(format!("transparent without an index of refraction Ni; {GLASS} used"));
                GLASS
            }
        };
        if self.roughness.is_some_and(|roughness| roughness > 0.0) {
            notes.push("rough glass is not modelled; it becomes smooth".into());
        }
        let filter = self.filter.unwrap_or(Rgb::WHITE);
        let transmittance = if filter.max_channel() < DARK_FILTER {
            let passing = Rgb::WHITE + filter * -1.0;
            notes.push(format!(
                "Tf {} is too dark for glass and is read as the share absorbed: transmittance {}",
                show(filter),
                show(passing)
            ));
            passing
        } else {
            within("Tf", filter, 1.0, notes)
        };
        // The Fresnel equations say how much a smooth boundary reflects; Ks does not enter.
        BsdfDescription::Dielectric { eta, reflectance: Rgb::WHITE, transmittance }
    }

    fn opaque(&self, emission: Rgb, notes: &mut Vec<String>) -> BsdfDescription {
        let diffuse = self.base_color(emission, notes);
        // Illumination models 0 and 1 have no highlight by definition.
        let specular = match self.illumination {
            Some(0 | 1) => Rgb::BLACK,
            _ => self.specular.unwrap_or(Rgb::BLACK),
        };
        let is_metal = self.metallic.is_some_and(|metallic| metallic >= 0.5);
        let lobe = if is_metal && specular.is_black() { diffuse } else { specular };
        if lobe.is_black() {
            return BsdfDescription::Lambert {
                reflectance: within("Kd", diffuse, 1.0, notes).into(),
            };
        }
        let dominant = is_metal || lobe.luminance() > diffuse.luminance();
        let narrow = self.lobe_roughness() < MIRROR_ROUGHNESS;
        if dominant && narrow {
            if self.lobe_roughness() > 0.0 {
                notes.push(format!(
                    "glossy reflection (roughness {:.3}) is not modelled; it becomes a mirror",
                    self.lobe_roughness()
                ));
            }
            if !is_metal && !diffuse.is_black() {
                let lost = show(diffuse);
                notes.push(format!("a mirror has no diffuse part; Kd {lost} is left out"));
            }
            return BsdfDescription::Mirror { reflectance: within("Ks", lobe, 1.0, notes) };
        }
        let sum = if lobe == diffuse { diffuse } else { diffuse + specular };
        let albedo = if sum.max_channel() > MAX_ALBEDO {
            sum * (MAX_ALBEDO / sum.max_channel())
        } else {
            sum
        };
        notes.push(format!(
            "glossy reflection (roughness {:.3}) is not modelled; it becomes diffuse with albedo {}",
            self.lobe_roughness(),
            show(albedo)
        ));
        BsdfDescription::Lambert { reflectance: albedo.into() }
    }

    /// `Kd` times the mean of its texture.
    fn base_color(&self, emission: Rgb, notes: &mut Vec<String>) -> Rgb {
        let unknown = || {
            let black = self.specular.is_some() || !emission.is_black();
            if black { Rgb::BLACK } else { Rgb::grey(UNKNOWN_GREY) }
        };
        match &self.diffuse_map {
            None => self.diffuse.unwrap_or_else(unknown),
            Some(Ok(mean)) => {
                notes.push(format!(
                    "map_Kd: textures are not modelled; the mean colour {} is used",
                    show(*mean)
                ));
                self.diffuse.unwrap_or(Rgb::WHITE) * *mean
            }
            Some(Err(error)) => {
                notes.push(format!("map_Kd: {error}; grey {UNKNOWN_GREY} is used instead"));
                self.diffuse.unwrap_or(Rgb::WHITE) * UNKNOWN_GREY
            }
        }
    }

    /// Roughness in the sense of a microfacet slope: 0 is a mirror, 1 is matt.
    fn lobe_roughness(&self) -> f64 {
        // Illumination models 3, 5 and 8 trace reflections: sharp ones, unless `Pr` says otherwise.
        match (self.roughness, self.illumination, self.shininess) {
            (Some(roughness), ..) => roughness.max(0.0),
            (None, Some(3 | 5 | 8), _) => 0.0,
            // The usual match of a Phong lobe with a Beckmann lobe of the same width.
            (None, _, Some(exponent)) => (2.0 / (exponent.max(0.0) + 2.0)).sqrt(),
            (None, _, None) => 1.0,
        }
    }
}

/// `color` with every channel at most `limit`.
fn within(field: &str, color: Rgb, limit: f64, notes: &mut Vec<String>) -> Rgb {
    if color.max_channel() <= limit {
        return color;
    }
    let scaled = color * (limit / color.max_channel());
    notes.push(format!(
        "{field} {} would reflect more light than arrives; scaled to {}",
        show(color),
        show(scaled)
    ));
    scaled
}

fn show(color: Rgb) -> String {
    format!("({:.3}, {:.3}, {:.3})", color.r, color.g, color.b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bsdf(entry: &MtlEntry) -> (BsdfDescription, usize) {
        let (material, notes) = entry.to_material();
        (material.bsdf, notes.len())
    }

    #[test]
    fn plain_models_need_no_note() {
        let matt = MtlEntry {
            diffuse: Some(Rgb::grey(0.7)),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        let expected = BsdfDescription::Lambert { reflectance: Rgb::grey(0.7).into() };
        assert_eq!(bsdf(&matt), (expected, 0));

        let glass = MtlEntry {
            diffuse: Some(Rgb::grey(0.0)),
            specular: Some(Rgb::grey(1.0)),
            filter: Some(Rgb::grey(1.0)),
            eta: Some(1.5),
            roughness: Some(0.0),
            illumination: Some(7),
            ..MtlEntry::default()
        };
        let expected = BsdfDescription::Dielectric {
            eta: 1.5,
            reflectance: Rgb::WHITE,
            transmittance: Rgb::WHITE,
        };
        assert_eq!(bsdf(&glass), (expected, 0));

        let mirror = MtlEntry {
            diffuse: Some(Rgb::grey(0.0)),
            specular: Some(Rgb::grey(0.9)),
            illumination: Some(5),
            shininess: Some(1000.0),
            ..MtlEntry::default()
        };
        assert_eq!(bsdf(&mirror), (BsdfDescription::Mirror { reflectance: Rgb::grey(0.9) }, 0));
    }

    #[test]
    fn an_opaque_material_with_a_filter_is_no_glass() {
        let light = MtlEntry {
            diffuse: Some(Rgb::grey(0.78)),
            filter: Some(Rgb::grey(1.0)),
            opacity: Some(1.0),
            eta: Some(1.5),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        assert!(matches!(bsdf(&light).0, BsdfDescription::Lambert { .. }), "illum 2 is opaque");
        let clear = MtlEntry { opacity: Some(0.1), ..light.clone() };
        assert!(matches!(bsdf(&clear).0, BsdfDescription::Dielectric { .. }), "d 0.1 is glass");
        let faint = MtlEntry { opacity: Some(0.9), ..light };
        let (model, notes) = bsdf(&faint);
        assert!(matches!(model, BsdfDescription::Lambert { .. }) && notes == 1, "d 0.9 is told");
    }

    #[test]
    fn a_dark_filter_is_the_share_absorbed() {
        let water = MtlEntry {
            filter: Some(Rgb::new(0.1, 0.1, 0.0)),
            eta: Some(1.33),
            illumination: Some(7),
            ..MtlEntry::default()
        };
        let BsdfDescription::Dielectric { transmittance, .. } = bsdf(&water).0 else {
            panic!("water is transparent");
        };
        assert_eq!(transmittance, Rgb::new(0.9, 0.9, 1.0));
    }

    #[test]
    fn glossy_materials_map_to_the_nearer_model_and_say_so() {
        let metal = |roughness| MtlEntry {
            diffuse: Some(Rgb::grey(0.0)),
            specular: Some(Rgb::grey(0.9)),
            roughness: Some(roughness),
            metallic: Some(1.0),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        assert!(matches!(bsdf(&metal(0.05)), (BsdfDescription::Mirror { .. }, 1)), "nearly sharp");
        assert!(matches!(bsdf(&metal(0.25)), (BsdfDescription::Lambert { .. }, 1)), "blurred");
        let phong = MtlEntry {
            diffuse: Some(Rgb::grey(0.5)),
            specular: Some(Rgb::grey(0.8)),
            shininess: Some(40.0),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        let (material, notes) = phong.to_material();
        let expected = BsdfDescription::Lambert { reflectance: Rgb::grey(0.95).into() };
        assert_eq!(material.bsdf, expected, "the lobes' sum, kept below one");
        assert!(notes[0].contains("glossy"), "{notes:?}");
    }

    #[test]
    fn textures_count_with_their_mean() {
        let painted = MtlEntry {
            diffuse: Some(Rgb::grey(0.5)),
            diffuse_map: Some(Ok(Rgb::new(0.2, 0.4, 0.6))),
            ..MtlEntry::default()
        };
        let expected = BsdfDescription::Lambert { reflectance: Rgb::new(0.1, 0.2, 0.3).into() };
        assert_eq!(bsdf(&painted), (expected, 1));
        let lost = MtlEntry { diffuse_map: Some(Err("a.png: gone".into())), ..MtlEntry::default() };
        let (material, notes) = lost.to_material();
        assert_eq!(material.bsdf, BsdfDescription::Lambert { reflectance: Rgb::grey(0.5).into() });
        assert!(notes[0].contains("a.png: gone"), "{notes:?}");
    }

    #[test]
    fn more_than_all_light_is_scaled_down() {
        let entry = MtlEntry { diffuse: Some(Rgb::new(2.0, 1.0, 0.0)), ..MtlEntry::default() };
        let expected = BsdfDescription::Lambert { reflectance: Rgb::new(1.0, 0.5, 0.0).into() };
        assert_eq!(bsdf(&entry), (expected, 1));
    }
}
