//! What a scene contains, found once, and what it therefore does not pay for.

use serde::Serialize;

use crate::bsdf::Bsdf;

/// What the transport code may have to deal with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SceneFeatures {
    /// Some reachable material has a Dirac lobe.
    pub specular: bool,
    /// Some shape is an analytic sphere.
    pub spheres: bool,
}

impl SceneFeatures {
    /// Looks through what is traced: the models of all surfaces, by material, and the number of
    /// analytic spheres.
    pub(super) fn of(used: &[&Bsdf], spheres: usize) -> Self {
        Self { specular: used.iter().any(|bsdf| bsdf.has_dirac_lobe()), spheres: spheres > 0 }
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
