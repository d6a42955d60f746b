//! What an MTL material means: the nearest model that Lvis has, and a warning where it is only near.

use common::Rgb;

use crate::bsdf::{
    BsdfDescription, ColorInput, ConductorDescription, DielectricDescription, Fresnel,
    LambertDescription, MirrorDescription, NumberInput, PlasticDescription,
};
use crate::scene::description::Material;

/// A texture that a material reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mapped {
    /// Its index.
    pub(crate) texture: u16,
    /// Its mean colour.
    pub(crate) mean: Rgb,
}

/// The roughness of a GGX lobe as wide as a Phong lobe of that exponent [Walter et al. 2007,
/// section 5.2].
pub(crate) fn phong_roughness(exponent: f64) -> f64 {
    (2.0 / (exponent.max(0.0) + 2.0)).sqrt()
}

/// The statements of one MTL material, as far as they matter here.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct MtlEntry {
    /// `newmtl`.
    pub(crate) name: String,
    /// `Kd`.
    pub(crate) diffuse: Option<Rgb>,
    /// `Ks`.
    pub(crate) specular: Option<Rgb>,
    /// `Ke`.
    pub(crate) emission: Option<Rgb>,
    /// `Tf`.
    pub(crate) filter: Option<Rgb>,
    /// `d`, or one less `Tr`: 1 is opaque.
    pub(crate) opacity: Option<f64>,
    /// `Ni`.
    pub(crate) eta: Option<f64>,
    /// `Ns`, a Phong exponent.
    pub(crate) shininess: Option<f64>,
    /// `Pr`, in [0, 1].
    pub(crate) roughness: Option<f64>,
    /// `Pm`, in [0, 1].
    pub(crate) metallic: Option<f64>,
    /// `illum`.
    pub(crate) illumination: Option<u8>,
    /// `map_Kd`, or `Err` when the image could not be read.
    pub(crate) diffuse_map: Option<Result<Mapped, String>>,
    /// `map_Pr`, or what `map_Ns` amounts to; `Err` when the image could not be read.
    pub(crate) roughness_map: Option<Result<Mapped, String>>,
    /// Mean of `map_Ke`, or `Err` when the image could not be read.
    pub(crate) emission_map: Option<Result<Rgb, String>>,
}

/// A base darker than this share of the reflection above it is none.
const DARK_BASE: f64 = 0.02;
/// `Ks` this near to what a dielectric of index `Ni` reflects at normal incidence means just that.
const COAT_MATCH: f64 = 0.01;
/// A surface more transparent than this is taken for glass, otherwise for opaque.
const GLASS_OPACITY: f64 = 0.5;
/// A transmission filter darker than this is taken for the share absorbed.
const DARK_FILTER: f64 = 0.5;
/// The index of refraction of glass, where none is given.
const GLASS: f64 = 1.5;
/// The grey of a surface whose colour is not known.
pub(crate) const UNKNOWN_GREY: f64 = 0.5;

impl MtlEntry {
    /// The nearest material, and what is not as the file says.
    pub(crate) fn to_material(&self) -> (Material, Vec<String>) {
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
                notes.push("map_Ke: emission textures are not supported; the mean is used".into());
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
            notes
                .push(format!("partial transparency is not supported; d {opacity} becomes opaque"));
        }
        false
    }

    fn glass(&self, notes: &mut Vec<String>) -> BsdfDescription {
        let eta = match self.eta {
            Some(eta) if eta > 0.0 => eta,
            _ => {
                notes.push(format!(
                    "transparent without an index of refraction Ni; {GLASS} is used"
                ));
                GLASS
            }
        };
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
        let roughness = self.roughness_input(self.roughness.unwrap_or(0.0).clamp(0.0, 1.0), notes);
        DielectricDescription { eta, reflectance: Rgb::WHITE, transmittance, roughness }.into()
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
            let reflectance = self.color_input(diffuse, notes);
            return LambertDescription { reflectance }.into();
        }
        let lobe = within("Ks", lobe, 1.0, notes);
        let roughness = self.lobe_roughness();
        // Illumination models 3 and 8 are mirrors without Fresnel's rise at grazing angles, and so
        // are those of 5 that are nothing but mirrors.
        let base_is_black = is_metal || diffuse.max_channel() < DARK_BASE * lobe.max_channel();
        if base_is_black && !is_metal && !diffuse.is_black() {
            let lost = show(diffuse);
            notes
                .push(format!("Kd {lost} is negligible next to such a reflection and was ignored"));
        }
        let fresnel = match self.illumination {
            Some(3 | 8) => Fresnel::Constant(lobe),
            Some(5) if base_is_black => Fresnel::Constant(lobe),
            _ => self.coat(lobe),
        };
        match (base_is_black, fresnel) {
            (true, Fresnel::Constant(reflectance))
                if roughness == 0.0 && self.roughness_map.is_none() =>
            {
                MirrorDescription { reflectance }.into()
            }
            (true, _) => {
                let fresnel = if is_metal { Fresnel::Schlick(lobe) } else { fresnel };
                let roughness = self.roughness_input(roughness, notes);
                ConductorDescription { fresnel, roughness }.into()
            }
            (false, _) => PlasticDescription {
                diffuse: self.color_input(diffuse, notes),
                fresnel,
                roughness: self.mean_roughness(roughness, notes),
                nonlinear: false,
            }
            .into(),
        }
    }

    /// What a coat reflects: a dielectric's by `Ni`, where `Ks` is what that reflects at normal
    /// incidence, and otherwise Schlick's approximation from `Ks`.
    fn coat(&self, specular: Rgb) -> Fresnel {
        let dielectric = self.eta.filter(|&eta| {
            let normal = ((eta - 1.0) / (eta + 1.0)).powi(2);
            (specular + Rgb::grey(-normal)).max_channel().abs() < COAT_MATCH
                && (Rgb::grey(normal) + specular * -1.0).max_channel().abs() < COAT_MATCH
        });
        match dielectric {
            Some(eta) => Fresnel::Dielectric { eta, tint: Rgb::WHITE },
            None => Fresnel::Schlick(specular),
        }
    }

    /// `Kd` times the mean of its texture.
    fn base_color(&self, emission: Rgb, notes: &mut Vec<String>) -> Rgb {
        let unknown = || {
            let black = self.specular.is_some() || !emission.is_black();
            if black { Rgb::BLACK } else { Rgb::grey(UNKNOWN_GREY) }
        };
        match &self.diffuse_map {
            None => self.diffuse.unwrap_or_else(unknown),
            Some(Ok(map)) => self.factor() * map.mean,
            Some(Err(error)) => {
                notes.push(format!("map_Kd: {error}; grey {UNKNOWN_GREY} is used instead"));
                self.diffuse.unwrap_or(Rgb::WHITE) * UNKNOWN_GREY
            }
        }
    }

    /// What a diffuse texture is multiplied by. Exporters that write only the map mean all of it.
    fn factor(&self) -> Rgb {
        self.diffuse.unwrap_or(Rgb::WHITE)
    }

    /// The diffuse colour, from its texture where there is one.
    fn color_input(&self, mean: Rgb, notes: &mut Vec<String>) -> ColorInput {
        match &self.diffuse_map {
            Some(Ok(map)) => {
                let factor = within("Kd", self.factor(), 1.0, notes);
                ColorInput::Texture { texture: map.texture, factor }
            }
            _ => within("Kd", mean, 1.0, notes).into(),
        }
    }

    /// The roughness, from its texture where there is one.
    fn roughness_input(&self, constant: f64, notes: &mut Vec<String>) -> NumberInput {
        match &self.roughness_map {
            Some(Ok(map)) => {
                // Beside `map_Pr`, `Pr` is a factor; `map_Ns` is roughness already.
                let factor = self.roughness.filter(|&pr| pr > 0.0).unwrap_or(1.0).min(1.0);
                NumberInput::Texture { texture: map.texture, factor }
            }
            Some(Err(error)) => {
                notes.push(format!("roughness texture: {error}; {constant:.3} is used instead"));
                constant.into()
            }
            None => constant.into(),
        }
    }

    /// The roughness of a coat, which is the same everywhere.
    fn mean_roughness(&self, constant: f64, notes: &mut Vec<String>) -> f64 {
        match self.roughness_input(constant, notes) {
            NumberInput::Constant(roughness) => roughness,
            NumberInput::Texture { factor, .. } => {
                let map = self.roughness_map.as_ref().and_then(|map| map.as_ref().ok());
                let mean = map.map_or(constant, |map| factor * map.mean.luminance());
                notes.push(format!("the roughness texture of a coat is its mean, {mean:.3}"));
                mean
            }
        }
    }

    /// Roughness in the sense of a microfacet slope, alpha of GGX: 0 is a mirror, 1 is matt.
    fn lobe_roughness(&self) -> f64 {
        // Illumination models 3, 5 and 8 trace reflections: sharp ones, unless `Pr` says otherwise.
        match (self.roughness, self.illumination, self.shininess) {
            (Some(roughness), ..) => roughness.clamp(0.0, 1.0),
            (None, Some(3 | 5 | 8), _) => 0.0,
            (None, _, Some(exponent)) => phong_roughness(exponent),
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
        let expected =
            BsdfDescription::Lambert(LambertDescription { reflectance: Rgb::grey(0.7).into() });
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
        let expected = BsdfDescription::from(DielectricDescription::clear(1.5));
        assert_eq!(bsdf(&glass), (expected, 0));

        let mirror = MtlEntry {
            diffuse: Some(Rgb::grey(0.0)),
            specular: Some(Rgb::grey(0.9)),
            illumination: Some(5),
            shininess: Some(1000.0),
            ..MtlEntry::default()
        };
        assert_eq!(
            bsdf(&mirror),
            (BsdfDescription::Mirror(MirrorDescription { reflectance: Rgb::grey(0.9) }), 0)
        );
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
        assert!(matches!(bsdf(&light).0, BsdfDescription::Lambert(_)), "illum 2 is opaque");
        let clear = MtlEntry { opacity: Some(0.1), ..light.clone() };
        assert!(matches!(bsdf(&clear).0, BsdfDescription::Dielectric(_)), "d 0.1 is glass");
        let faint = MtlEntry { opacity: Some(0.9), ..light };
        let (model, notes) = bsdf(&faint);
        assert!(matches!(model, BsdfDescription::Lambert(_)) && notes == 1, "d 0.9 is told");
    }

    #[test]
    fn a_dark_filter_is_the_share_absorbed() {
        let water = MtlEntry {
            filter: Some(Rgb::new(0.1, 0.1, 0.0)),
            eta: Some(1.33),
            illumination: Some(7),
            ..MtlEntry::default()
        };
        let BsdfDescription::Dielectric(DielectricDescription { transmittance, .. }) =
            bsdf(&water).0
        else {
            panic!("water is transparent");
        };
        assert_eq!(transmittance, Rgb::new(0.9, 0.9, 1.0));
    }

    #[test]
    fn roughness_comes_from_pr_or_the_phong_exponent() {
        let metal = |roughness| MtlEntry {
            diffuse: Some(Rgb::grey(0.0)),
            specular: Some(Rgb::grey(0.9)),
            roughness: Some(roughness),
            shininess: Some(10.0),
            metallic: Some(1.0),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        let fresnel = Fresnel::Schlick(Rgb::grey(0.9));
        let brushed =
            BsdfDescription::Conductor(ConductorDescription { fresnel, roughness: 0.25.into() });
        assert_eq!(bsdf(&metal(0.25)), (brushed, 0));
        let phong = MtlEntry {
            diffuse: Some(Rgb::grey(0.5)),
            specular: Some(Rgb::grey(0.8)),
            shininess: Some(198.0),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        let lacquer = BsdfDescription::Plastic(PlasticDescription {
            diffuse: Rgb::grey(0.5).into(),
            fresnel: Fresnel::Schlick(Rgb::grey(0.8)),
            roughness: 0.1,
            nonlinear: false,
        });
        assert_eq!(bsdf(&phong), (lacquer, 0));
    }

    #[test]
    fn a_coat_of_known_index_is_a_dielectric() {
        let wood = MtlEntry {
            diffuse: Some(Rgb::grey(0.6)),
            specular: Some(Rgb::grey(0.04)),
            eta: Some(1.5),
            roughness: Some(0.1),
            illumination: Some(2),
            ..MtlEntry::default()
        };
        let (BsdfDescription::Plastic(PlasticDescription { fresnel, .. }), 0) = bsdf(&wood) else {
            panic!("a coat over a base");
        };
        assert_eq!(fresnel, Fresnel::Dielectric { eta: 1.5, tint: Rgb::WHITE });
        let frosted = MtlEntry {
            eta: Some(1.5),
            roughness: Some(0.3),
            illumination: Some(7),
            ..MtlEntry::default()
        };
        let expected =
            DielectricDescription { roughness: 0.3.into(), ..DielectricDescription::clear(1.5) };
        assert_eq!(bsdf(&frosted), (expected.into(), 0), "frosted glass");
    }

    #[test]
    fn textures_are_read_times_their_colour() {
        let painted = MtlEntry {
            diffuse: Some(Rgb::grey(0.5)),
            diffuse_map: Some(Ok(Mapped { texture: 3, mean: Rgb::new(0.2, 0.4, 0.6) })),
            ..MtlEntry::default()
        };
        let reflectance = ColorInput::Texture { texture: 3, factor: Rgb::grey(0.5) };
        assert_eq!(
            bsdf(&painted),
            (BsdfDescription::Lambert(LambertDescription { reflectance }), 0)
        );
        let worn = MtlEntry {
            specular: Some(Rgb::grey(0.9)),
            metallic: Some(1.0),
            roughness_map: Some(Ok(Mapped { texture: 1, mean: Rgb::grey(0.3) })),
            ..MtlEntry::default()
        };
        let (BsdfDescription::Conductor(ConductorDescription { roughness, .. }), 0) = bsdf(&worn)
        else {
            panic!("a metal");
        };
        assert_eq!(roughness, NumberInput::Texture { texture: 1, factor: 1.0 });
        let lost = MtlEntry { diffuse_map: Some(Err("a.png: gone".into())), ..MtlEntry::default() };
        let (material, notes) = lost.to_material();
        assert_eq!(
            material.bsdf,
            BsdfDescription::Lambert(LambertDescription { reflectance: Rgb::grey(0.5).into() })
        );
        assert!(notes[0].contains("a.png: gone"), "{notes:?}");
    }

    #[test]
    fn more_than_all_light_is_scaled_down() {
        let entry = MtlEntry { diffuse: Some(Rgb::new(2.0, 1.0, 0.0)), ..MtlEntry::default() };
        let expected = BsdfDescription::Lambert(LambertDescription {
            reflectance: Rgb::new(1.0, 0.5, 0.0).into(),
        });
        assert_eq!(bsdf(&entry), (expected, 1));
    }
}
