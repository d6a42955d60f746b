//! What lies under the cursor: paths and surfaces. Pure arithmetic over what the viewer holds.

use common::{SceneMesh, VertexRecord};
use glam::{Vec2, Vec3, Vec4};

use crate::camera::{Lens, NEAR};
use crate::settings::SceneSettings;
use crate::source::selection::Selection;
use crate::source::store::Store;
use crate::value::{Bounds, Pointer};

/// Paths that one click finds at most; more than anybody clicks through.
const MOST_HITS: usize = 64;

/// A path under the cursor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The page that holds it.
    pub page: u64,
    /// Its index in the page.
    pub index: usize,
    /// The vertex at the light end of the segment that was hit.
    pub segment: usize,
    /// How far off the segment lies, as a tangent.
    pub miss: f32,
    /// Distance along the view direction where it is closest, in scene units.
    pub depth: f32,
}

/// What may be hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pickable {
    /// How many of the newest paths are drawn.
    pub newest: usize,
    /// The plane whose positive side is drawn.
    pub clip: Vec4,
}

/// The paths under the cursor: those in front of the surface there first, closest to the cursor
/// first among them.
pub fn paths_at(
    store: &Store,
    lens: &Lens,
    pointer: Pointer,
    of: Pickable,
    surface: Option<f32>,
) -> Vec<Hit> {
    let beam = PickFrustum::new(lens, pointer, of.clip);
    let mut hits = Vec::new();
    let mut left = of.newest;
    let mut codes = Vec::new();
    for page in store.pages().rev() {
        codes.clear();
        codes.extend(page.all_vertices().iter().map(|v| beam.code(v.position.into())));
        let drawn = page.paths().iter().enumerate().rev();
        let drawn = drawn.filter(|(_, path)| store.drawn().includes(path)).take(left);
        for (index, path) in drawn {
            left -= 1;
            let of_path = codes.get(path.range()).unwrap_or_default();
            let vertices = page.vertices(path);
            if let Some((segment, miss, depth)) = beam.closest(of_path, vertices) {
                hits.push(Hit { page: page.serial(), index, segment, miss, depth });
            }
        }
        if left == 0 {
            break;
        }
    }
    let behind = |hit: &Hit| surface.is_some_and(|depth| hit.depth > 1.001 * depth);
    hits.sort_by(|a, b| {
        behind(a).cmp(&behind(b)).then(a.miss.total_cmp(&b.miss)).then(a.depth.total_cmp(&b.depth))
    });
    hits.truncate(MOST_HITS);
    hits
}

/// A thin pyramid round the line of sight through the cursor.
struct PickFrustum<'a> {
    lens: &'a Lens,
    at: Vec2,
    reach: f32,
    clip: Vec4,
    /// Tangents of its four sides: left, right, lower, upper.
    sides: [f32; 4],
}

impl<'a> PickFrustum<'a> {
    fn new(lens: &'a Lens, pointer: Pointer, clip: Vec4) -> Self {
        let [x, y] = pointer.at;
        let sides = [x - pointer.reach, x + pointer.reach, y - pointer.reach, y + pointer.reach];
        Self { lens, at: Vec2::new(x, y), reach: pointer.reach, clip, sides }
    }

    /// The sides that a point lies outside of, one bit each: a segment whose ends share one cannot
    /// cross the beam.
    fn code(&self, point: Vec3) -> u8 {
        let [left, right, lower, upper] = self.sides;
        let d = point - self.lens.eye;
        let (x, y, z) = (d.dot(self.lens.right), d.dot(self.lens.up), d.dot(self.lens.forward));
        u8::from(x < left * z)
            | u8::from(x > right * z) << 1
            | u8::from(y < lower * z) << 2
            | u8::from(y > upper * z) << 3
            | u8::from(z < 0.0) << 4
    }

    /// The segment of a path that comes closest, how close, and at which depth.
    fn closest(&self, codes: &[u8], vertices: &[VertexRecord]) -> Option<(usize, f32, f32)> {
        let mut best: Option<(usize, f32, f32)> = None;
        for (i, pair) in codes.windows(2).enumerate() {
            if let [a, b] = *pair
                && a & b == 0
                && let Some([a, b]) = vertices.get(i..i + 2).and_then(|v| v.first_chunk::<2>())
                && let Some((miss, depth)) = self.miss(a.position.into(), b.position.into())
                && best.is_none_or(|(_, least, _)| miss < least)
            {
                best = Some((i, miss, depth));
            }
        }
        best
    }

    /// How far off a segment lies, and at which depth it is closest; `None` when too far.
    fn miss(&self, a: Vec3, b: Vec3) -> Option<(f32, f32)> {
        let view = |p: Vec3| {
            let d = p - self.lens.eye;
            Vec3::new(d.dot(self.lens.right), d.dot(self.lens.up), d.dot(self.lens.forward))
        };
        let (mut p, mut q) = (view(a), view(b));
        if p.z < NEAR {
            p = p.lerp(q, (NEAR - p.z) / (q.z - p.z));
        } else if q.z < NEAR {
            q = q.lerp(p, (NEAR - q.z) / (p.z - q.z));
        }
        let (p2, q2) = (p.truncate() / p.z, q.truncate() / q.z);
        let along = q2 - p2;
        let length2 = along.length_squared();
        let t =
            if length2 > 0.0 { ((self.at - p2).dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
        let miss = (p2 + t * along - self.at).length();
        // Inverse depth is what is linear on the screen.
        let depth = 1.0 / ((1.0 - t) / p.z + t / q.z);
        let place = self.lens.at(self.at.into(), depth);
        let drawn = self.clip.truncate().dot(place) + self.clip.w >= 0.0;
        (miss <= self.reach && drawn).then_some((miss, depth))
    }
}

/// Distance along the view direction to the first surface at `at`, and the point hit there.
/// Surfaces seen from behind count when `backs` says so.
pub fn surface_at(
    mesh: &SceneMesh,
    lens: &Lens,
    at: [f32; 2],
    backs: bool,
    clip: Vec4,
) -> Option<(f32, Vec3)> {
    // As long as its depth is one, so that distances along it are depths.
    let ray = lens.at(at, 1.0) - lens.eye;
    let corner = |index: u32| mesh.positions.get(index as usize).copied().map(Vec3::from);
    let mut nearest: Option<(f32, Vec3)> = None;
    for triangle in &mesh.triangles {
        let [Some(a), Some(b), Some(c)] = triangle.map(corner) else { continue };
        let Some(depth) = triangle_depth(lens.eye, ray, [a, b, c], backs) else { continue };
        let place = lens.eye + depth * ray;
        let drawn = clip.truncate().dot(place) + clip.w >= 0.0;
        if drawn && depth >= NEAR && nearest.is_none_or(|(least, _)| depth < least) {
            nearest = Some((depth, place));
        }
    }
    nearest
}

/// Where a ray meets a triangle [Möller and Trumbore 1997].
fn triangle_depth(eye: Vec3, ray: Vec3, [a, b, c]: [Vec3; 3], backs: bool) -> Option<f32> {
    let (e1, e2) = (b - a, c - a);
    let p = ray.cross(e2);
    let determinant = e1.dot(p);
    if !(determinant.abs() > 1e-12) || (determinant < 0.0 && !backs) {
        return None;
    }
    let s = eye - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(e1);
    let v = ray.dot(q) / determinant;
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    let depth = e2.dot(q) / determinant;
    (inside && depth > 0.0).then_some(depth)
}

/// What can be seen of the paths.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// The paths.
    pub store: &'a Store,
    /// The eye.
    pub lens: &'a Lens,
    /// The box round the scene.
    pub bounds: Bounds,
    /// How surfaces are drawn.
    pub scene: &'a SceneSettings,
    /// The surfaces.
    pub mesh: Option<&'a SceneMesh>,
    /// So many of the newest paths are drawn.
    pub newest: usize,
}

impl Sight<'_> {
    /// The paths under the cursor, in the order in which clicks go through them.
    pub fn paths(&self, pointer: Pointer) -> Vec<Selection> {
        let clip = self.scene.clip_plane(self.bounds);
        let mesh = self.mesh.filter(|_| self.scene.covers());
        let surface = mesh
            .and_then(|mesh| surface_at(mesh, self.lens, pointer.at, !self.scene.cutaway, clip))
            .map(|(depth, _)| depth);
        let pickable = Pickable { newest: self.newest, clip };
        let hits = paths_at(self.store, self.lens, pointer, pickable, surface);
        let found = hits.iter().filter_map(|hit| {
            let page = self.store.page(hit.page)?;
            let path = page.paths().get(hit.index)?;
            Some(Selection::new(path.header, page.vertices(path).to_vec()))
        });
        let mut found: Vec<Selection> = found.collect();
        let count = found.len();
        for (i, selection) in found.iter_mut().enumerate() {
            selection.place = (i + 1, count);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::batch;

    /// Looks along -z from z = 1500, as the made-up camera does.
    fn lens() -> Lens {
        Lens {
            eye: Vec3::new(0.0, 0.0, 1500.0),
            right: Vec3::X,
            up: Vec3::Y,
            forward: -Vec3::Z,
            tan_y: 0.4,
            aspect: 1.5,
        }
    }

    const ALL: Pickable = Pickable { newest: usize::MAX, clip: Vec4::W };

    fn store() -> Store {
        let mut store = Store::new(usize::MAX);
        store.append(&batch(&[
            &[[-400.0, 0.0, -500.0], [400.0, 0.0, -500.0]],
            &[[-400.0, 30.0, 500.0], [400.0, 30.0, 500.0]],
            &[[-400.0, 300.0, 0.0], [400.0, 300.0, 0.0]],
        ]));
        store
    }

    #[test]
    fn a_click_finds_what_is_near_it_and_nothing_else() {
        let store = store();
        let at = |x: f32, y: f32, reach: f32| {
            let pointer = Pointer { at: [x, y], reach };
            let hits = paths_at(&store, &lens(), pointer, ALL, None);
            hits.iter().map(|h| (h.index, h.segment)).collect::<Vec<_>>()
        };
        // The paths lie at 0 / 2000, 30 / 1000 and 300 / 1500 above the middle.
        assert_eq!(at(0.01, 0.0, 0.005), [(0, 0)], "the middle");
        assert_eq!(at(0.01, 0.03, 0.005), [(1, 0)], "above it");
        assert_eq!(at(0.01, 0.012, 0.02), [(0, 0), (1, 0)], "between, the closer first");
        assert_eq!(at(0.01, 0.1, 0.02), [], "nothing there");
        assert_eq!(at(0.3, 0.2, 0.01), [], "beyond the end of the third");
    }

    #[test]
    fn paths_behind_a_surface_come_last() {
        let pointer = Pointer { at: [0.01, 0.012], reach: 0.02 };
        let order = |surface| {
            let hits = paths_at(&store(), &lens(), pointer, ALL, surface);
            hits.iter().map(|h| h.index).collect::<Vec<_>>()
        };
        assert_eq!(order(Some(1200.0)), [1, 0], "the farther path is hidden");
        assert_eq!(order(Some(3000.0)), [0, 1], "both are seen");
    }

    #[test]
    fn only_what_is_drawn_is_found() {
        let pointer = Pointer { at: [0.01, 0.012], reach: 0.02 };
        let newest = Pickable { newest: 2, ..ALL };
        assert_eq!(
            paths_at(&store(), &lens(), pointer, newest, None).len(),
            1,
            "the oldest is not drawn"
        );
        let front = Pickable { clip: Vec4::new(0.0, 0.0, 1.0, 0.0), ..ALL };
        let hits = paths_at(&store(), &lens(), pointer, front, None);
        assert_eq!(hits.iter().map(|h| h.index).collect::<Vec<_>>(), [1], "one is cut away");
    }

    #[test]
    fn surfaces_are_hit_where_they_are() {
        let mesh = SceneMesh {
            positions: vec![[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..SceneMesh::default()
        };
        let (depth, place) =
            surface_at(&mesh, &lens(), [0.001, 0.0], false, Vec4::W).expect("a hit");
        assert!((depth - 1500.0).abs() < 0.01, "depth {depth}");
        assert!((place - Vec3::new(1.5, 0.0, 0.0)).length() < 0.01, "place {place}");
        assert_eq!(surface_at(&mesh, &lens(), [0.1, 0.0], true, Vec4::W), None, "beside it");
        let turned = SceneMesh { triangles: vec![[1, 0, 2]], ..mesh };
        assert_eq!(surface_at(&turned, &lens(), [0.0, 0.0], false, Vec4::W), None, "its back");
        assert!(surface_at(&turned, &lens(), [0.0, 0.0], true, Vec4::W).is_some(), "wanted");
    }
}
