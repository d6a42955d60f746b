//! The sensor: where the picture is taken from, and its size.

use common::CameraPose;
use glam::{DMat3, DVec3};

use super::document::Element;
use crate::scene::description::ThinLens;
use crate::scene::reading::diagnostic::{LoadError, Warning};
use crate::scene::reading::viewpoint::Viewpoint;

/// Sides of a film that does not tell its own, in pixels.
const DEFAULT_FILM: [u32; 2] = [768, 576];
/// The diagonal of a frame of 35 mm film in millimetres, which focal lengths refer to.
const DIAGONAL_35_MM: f64 = 43.266_615_305_567_87;

/// A sensor, and what of it is not supported.
#[derive(Debug)]
pub(super) struct Sensor {
    /// Camera and film.
    pub(super) view: Viewpoint,
    /// The depths at which it cuts the scene off.
    pub(super) clip: [f64; 2],
    /// Its lens, where it is no pinhole.
    pub(super) lens: Option<ThinLens>,
    /// What is not modelled of it.
    pub(super) warnings: Vec<Warning>,
}

/// Reads a `sensor`.
pub(super) fn read(sensor: Element<'_>) -> Result<Sensor, LoadError> {
    let mut warnings = Vec::new();
    let lens = match sensor.plugin()?.as_str() {
        "perspective" => None,
        "thinlens" => Some(thin_lens(sensor)?),
        _ => {
            let message = "unknown sensor; supported: perspective, thinlens";
            return Err(sensor.error(message));
        }
    };
    let [width, height] = film(sensor, &mut warnings)?;
    let to_world = sensor.transform("to_world")?;
    let linear = DMat3::from_mat4(to_world);
    if linear.determinant() < 0.0 {
        let message = "its transform mirrors the picture; remove the scale with a negative factor, \
                       or make it negative for two axes";
        return Err(sensor.error(message));
    }
    let origin = to_world.transform_point3(DVec3::ZERO);
    // A scale has no bearing on directions, but lets a target be too near to be told apart.
    let forward = (linear * DVec3::Z).normalize_or_zero();
    let camera = CameraPose {
        origin,
        target: origin + forward * origin.abs().max_element().max(1.0),
        up: (linear * DVec3::Y).normalize_or_zero(),
        vertical_fov: vertical_fov(sensor, f64::from(width) / f64::from(height))?,
    };
    let clip = [
        sensor.number("near_clip")?.unwrap_or(0.0),
        sensor.number("far_clip")?.unwrap_or(f64::INFINITY),
    ];
    Ok(Sensor { view: Viewpoint { camera, width, height }, clip, lens, warnings })
}

fn thin_lens(sensor: Element<'_>) -> Result<ThinLens, LoadError> {
    let length = |name: &str| match sensor.number(name)? {
        Some(length) if length > 0.0 => Ok(length),
        Some(length) => Err(sensor.error(format!("{name} is {length}; it must be positive"))),
        None => Err(sensor.error(format!("the parameter `{name}` is missing"))),
    };
    Ok(ThinLens { radius: length("aperture_radius")?, focus: length("focus_distance")? })
}

fn film(sensor: Element<'_>, warnings: &mut Vec<Warning>) -> Result<[u32; 2], LoadError> {
    let Some(film) = sensor.objects("film")?.first().copied() else { return Ok(DEFAULT_FILM) };
    let side = |name, default| match film.integer(name)? {
        None => Ok(default),
        Some(side) => u32::try_from(side).ok().filter(|&side| side > 0).ok_or_else(|| {
            film.error(format!("{name} is {side}; it must be a positive number of pixels"))
        }),
    };
    let size = [side("width", DEFAULT_FILM[0])?, side("height", DEFAULT_FILM[1])?];
    let cropped = ["crop_width", "crop_height", "crop_offset_x", "crop_offset_y"];
    let mut crop = false;
    for name in cropped {
        crop |= film.integer(name)?.is_some();
    }
    if crop {
        warnings.push(film.warning("the crop window is ignored: the whole picture is rendered"));
    }
    for filter in film.objects("rfilter")? {
        let kind = filter.plugin()?;
        if kind != "box" {
            let message = format!("pixels are averaged over their own square, not by `{kind}`");
            warnings.push(filter.warning(message));
        }
    }
    Ok(size)
}

/// The full vertical field of view in degrees.
fn vertical_fov(sensor: Element<'_>, aspect: f64) -> Result<f64, LoadError> {
    let (axis, fov) = match sensor.number("fov")? {
        Some(fov) => (sensor.string("fov_axis")?, fov),
        None => (Some("diagonal".to_owned()), fov_of_focal_length(sensor)?),
    };
    if !(fov > 0.0 && fov < 180.0) {
        return Err(sensor.error(format!("fov is {fov}; it must lie between 0 and 180 degrees")));
    }
    // The film's height over its extent along the axis of the angle.
    let across = match axis.as_deref() {
        None | Some("x") => 1.0 / aspect,
        Some("y") => 1.0,
        Some("smaller") => (1.0 / aspect).max(1.0),
        Some("larger") => (1.0 / aspect).min(1.0),
        Some("diagonal") => 1.0 / aspect.hypot(1.0),
        Some(other) => {
            let message =
                format!("fov_axis is `{other}`; it must be x, y, diagonal, smaller or larger");
            return Err(sensor.error(message));
        }
    };
    let tan_y = across * (0.5 * fov.to_radians()).tan();
    Ok(2.0 * tan_y.atan().to_degrees())
}

/// The diagonal field of view in degrees of a lens before 35 mm film; 50 mm where nothing is said.
fn fov_of_focal_length(sensor: Element<'_>) -> Result<f64, LoadError> {
    let text = sensor.string("focal_length")?.unwrap_or_else(|| "50mm".to_owned());
    let length = text.trim().trim_end_matches("mm").trim().parse::<f64>();
    match length {
        Ok(length) if length > 0.0 && length.is_finite() => {
            Ok(2.0 * (0.5 * DIAGONAL_35_MM / length).atan().to_degrees())
        }
        _ => Err(sensor.error("focal_length must be a positive number of millimetres, as `50mm`")),
    }
}
