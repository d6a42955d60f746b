//! The path that the user looks at: a copy, so that it stays when the store drops the original.

use std::sync::Arc;
use std::time::Instant;

use common::{PathDetail, PathHeader, Rgb, SceneFrame, SceneMesh, VertexRecord, decode_normal};
use glam::{DVec3, Vec3};

use crate::source::store::class_name;
use crate::value::VertexStep;

/// A selected path.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// All but the vertices.
    pub header: PathHeader,
    /// From the light to the lens.
    pub vertices: Vec<VertexRecord>,
    /// The vertex that is looked at.
    pub vertex: Option<usize>,
    /// The numbers behind it.
    pub detail: Detail,
    /// Which of the paths under the cursor it is, counted from one, and how many there are.
    pub place: (usize, usize),
}

/// What is known of the numbers behind a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Detail {
    /// Nobody was asked.
    #[default]
    Unasked,
    /// The daemon was asked then.
    Asked(Instant),
    /// They are known.
    Known(Arc<PathDetail>),
    /// They are not to be had, for a reason that people understand.
    Missing(String),
}

/// What names and units the panels and the text form of a path need.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// How scene units relate to those of the file.
    pub frame: Option<SceneFrame>,
    /// Names of the strategies.
    pub strategies: &'a [String],
    /// The surfaces, for their materials.
    pub mesh: Option<&'a SceneMesh>,
}

impl Names<'_> {
    /// A point in the units of the scene file.
    pub fn world(&self, position: [f32; 3]) -> DVec3 {
        let scene = Vec3::from(position).as_dvec3();
        self.frame.map_or(scene, |frame| frame.to_world(scene))
    }

    /// A point of the scene file in scene units.
    pub fn scene(&self, world: DVec3) -> DVec3 {
        self.frame.map_or(world, |frame| frame.to_scene(world))
    }

    /// What a path counts, in luminance of the image.
    pub fn luminance(&self, header: &PathHeader) -> f64 {
        f64::from(header.luminance) * self.frame.map_or(1.0, |frame| frame.light)
    }

    /// The name of the material at a vertex; a dash where there is no surface.
    pub fn material(&self, vertex: &VertexRecord) -> &str {
        if vertex.primitive == u32::MAX {
            return "–";
        }
        let index = vertex.material;
        let materials = self.mesh.map(|mesh| mesh.materials.as_slice()).unwrap_or_default();
        materials.get(usize::from(index)).map_or("–", |material| material.name.as_str())
    }

    /// The name of the object at a vertex, where it has one.
    pub fn object(&self, vertex: &VertexRecord) -> Option<&str> {
        self.mesh?.object(vertex.primitive).filter(|name| !name.is_empty())
    }

    /// The name of the strategy that proposed a path.
    pub fn strategy(&self, header: &PathHeader) -> &str {
        let name = self.strategies.get(usize::from(header.strategy.0));
        match name {
            Some(name) => name,
            None if header.strategy == PathHeader::NO_STRATEGY => "seed",
            None => "unknown strategy",
        }
    }
}

impl Selection {
    /// A path of which no vertex is looked at.
    pub fn new(header: PathHeader, vertices: Vec<VertexRecord>) -> Self {
        Self { header, vertices, vertex: None, detail: Detail::Unasked, place: (1, 1) }
    }

    /// The numbers behind it, where they are known.
    pub fn numbers(&self) -> Option<&PathDetail> {
        match &self.detail {
            Detail::Known(detail) => Some(detail),
            Detail::Unasked | Detail::Asked(_) | Detail::Missing(_) => None,
        }
    }

    /// Goes to another vertex, round the ends.
    pub fn go(&mut self, step: VertexStep) {
        let Some(last) = self.vertices.len().checked_sub(1) else { return };
        self.vertex = Some(match (step, self.vertex) {
            (VertexStep::To(index), _) => usize::from(index).min(last),
            (VertexStep::Next, None) => 0,
            (VertexStep::Previous, None) => last,
            (VertexStep::Next, Some(index)) => (index + 1) % (last + 1),
            (VertexStep::Previous, Some(index)) => (index + last) % (last + 1),
        });
    }

    /// Its class with blanks, such as `L S S D E`.
    pub fn class(&self) -> String {
        let letters: Vec<String> = class_name(&self.vertices).chars().map(String::from).collect();
        letters.join(" ")
    }

    /// Its number of edges.
    pub fn edge_count(&self) -> usize {
        self.vertices.len().saturating_sub(1)
    }

    /// The length of the edge before a vertex, in the units of the file.
    pub fn edge_length(&self, vertex: usize, names: &Names<'_>) -> Option<f64> {
        let before = self.vertices.get(vertex.checked_sub(1)?)?;
        let here = self.vertices.get(vertex)?;
        Some((names.world(here.position) - names.world(before.position)).length())
    }

    /// Everything that is known of it, as text for the clipboard.
    pub fn text(&self, names: &Names<'_>) -> String {
        let h = &self.header;
        let [r, g, b] = h.rgb;
        let mut text = format!(
            "path {}  class {}  {} edges\nstrategy {}  acceptance {:.6}  dwell {}  weight {}\n\
             luminance {:.6e}  colour {r:.4} {g:.4} {b:.4}  film {:.6} {:.6}\n",
            h.id,
            self.class(),
            self.edge_count(),
            names.strategy(h),
            h.acceptance,
            h.dwell,
            h.weight,
            names.luminance(h),
            h.film[0],
            h.film[1],
        );
        for (i, vertex) in self.vertices.iter().enumerate() {
            let p = names.world(vertex.position);
            let n = decode_normal(vertex.normal);
            let line = format!(
                "x{i} {} {:<8} position {:.6} {:.6} {:.6}  normal {:.4} {:.4} {:.4}  material {}  \
                 object {}",
                vertex.kind.letter(),
                vertex.event.name(),
                p.x,
                p.y,
                p.z,
                n.x,
                n.y,
                n.z,
                names.material(vertex),
                names.object(vertex).unwrap_or("–"),
            );
            text.push_str(&line);
            text.push('\n');
        }
        if let Some(detail) = self.numbers() {
            text.push_str(&numbers_text(detail));
        }
        text
    }
}

/// Densities, throughputs and geometry of every vertex, and what each split counts, one a line.
pub fn numbers_text(detail: &PathDetail) -> String {
    let mut lines = Vec::new();
    for (i, vertex) in detail.vertices.iter().enumerate() {
        let geometry =
            detail.geometry.get(i).map_or_else(|| "–".to_owned(), |g| format!("{g:.9e}"));
        lines.push(format!(
            "x{i} from light: pdf {:.9e} throughput {}  from eye: pdf {:.9e} throughput {}  G to x{} \
             {geometry}",
            vertex.light_pdf,
            triple(detail.light_throughput(i)),
            vertex.eye_pdf,
            triple(detail.eye_throughput(i)),
            i + 1,
        ));
    }
    for (light, reciprocal) in detail.reciprocals.iter().enumerate() {
        let counts = if *reciprocal > 0.0 {
            format!("C {:.9e} weight {:.9}", 1.0 / reciprocal, detail.share(light))
        } else {
            "cannot make it".to_owned()
        };
        lines.push(format!("split {light} from light: {counts}"));
    }
    lines.push(String::new());
    lines.join("\n")
}

fn triple(color: Rgb) -> String {
    format!("{:.6e} {:.6e} {:.6e}", color.r, color.g, color.b)
}
