//! What a scene contains, found once, and what it therefore does not pay for.

use serde::Serialize;

use super::SceneDescription;

/// What the transport code may have to deal with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SceneFeatures {
    /// Some reachable material has a Dirac lobe.
    pub specular: bool,
    /// Some shape is an analytic sphere.
    pub spheres: bool,
}

impl SceneFeatures {
    /// Looks through a description for what its shapes use.
    pub fn of(description: &SceneDescription) -> Self {
        let is_specular = |material: u16| {
            description
                .materials
                .get(usize::from(material))
                .is_some_and(|m| m.bsdf.has_dirac_lobe())
        };
        let mut used = description
            .meshes
            .iter()
            .flat_map(|mesh| mesh.materials.iter().copied())
            .chain(description.spheres.iter().map(|sphere| sphere.material));
        Self { specular: used.any(is_specular), spheres: !description.spheres.is_empty() }
    }

    /// What the absent features switch off, in words, for the log and for people.
    pub fn switched_off(self) -> Vec<&'static str> {
        let mut off = Vec::new();
        if !self.specular {
            off.push("no mirror or glass: every vertex can be connected, and the multi-chain perturbation is off");
        }
        if !self.spheres {
            off.push("no analytic sphere: the sphere tree is never searched");
        }
        off
    }
}
