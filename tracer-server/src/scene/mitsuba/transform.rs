//! Transforms: steps that apply in the order in which they stand.

use glam::{DMat3, DMat4, DVec3, DVec4};

use super::document::Element;
use super::value::numbers;
use crate::scene::reading::diagnostic::LoadError;

impl Element<'_> {
    /// A `transform` parameter; the identity where it is absent.
    pub(super) fn transform(&self, name: &str) -> Result<DMat4, LoadError> {
        let Some(transform) = self.property(name)? else { return Ok(DMat4::IDENTITY) };
        if transform.tag() != "transform" {
            return Err(transform.error("expected a `<transform>`"));
        }
        let mut product = DMat4::IDENTITY;
        for step in transform.children() {
            product = step.read().step()? * product;
        }
        let linear = DMat3::from_mat4(product).determinant();
        if !product.is_finite() || !linear.is_finite() || linear == 0.0 {
            let message = "its steps are singular or exceed the range of numbers; no scale may be \
                zero";
            return Err(transform.error(message));
        }
        Ok(product)
    }

    fn step(&self) -> Result<DMat4, LoadError> {
        match self.tag() {
            "translate" => Ok(DMat4::from_translation(self.triple(0.0)?)),
            "scale" => Ok(DMat4::from_scale(self.triple(1.0)?)),
            "rotate" => {
                let degrees = self
                    .attribute_number("angle")?
                    .ok_or_else(|| self.error("the attribute `angle` is missing, in degrees"))?;
                let axis = self.triple(0.0)?.try_normalize();
                let axis = axis.ok_or_else(|| self.error("the axis is zero; give x, y or z"))?;
                Ok(DMat4::from_axis_angle(axis, degrees.to_radians()))
            }
            "lookat" | "lookAt" | "look_at" => self.look_at(),
            "matrix" => self.matrix(),
            _ => Err(self.error(
                "not a step of a transform; supported: translate, rotate, scale, lookat, matrix",
            )),
        }
    }

    /// Takes +z to the direction of view, +x to the left and +y up.
    fn look_at(&self) -> Result<DMat4, LoadError> {
        let (origin, target) = (self.attribute_triple("origin")?, self.attribute_triple("target")?);
        let forward = (target - origin).try_normalize();
        let forward = forward.ok_or_else(|| self.error("origin and target are the same point"))?;
        let up = if self.attribute("up")?.is_some() {
            self.attribute_triple("up")?
        } else {
            // Any direction will do: whatever is turned by it looks the same from all sides.
            forward.any_orthonormal_vector()
        };
        let left = up.cross(forward).try_normalize();
        let left =
            left.ok_or_else(|| self.error("up is zero or parallel to the view direction"))?;
        let axes = [left, forward.cross(left), forward];
        let [x, y, z] = axes.map(|axis| axis.extend(0.0));
        Ok(DMat4::from_cols(x, y, z, origin.extend(1.0)))
    }

    /// Sixteen numbers row by row, or nine for a transform that leaves the origin alone.
    fn matrix(&self) -> Result<DMat4, LoadError> {
        let value = self.needed("value")?;
        let numbers = numbers(&value).map_err(|message| self.error(message))?;
        let matrix = if let Ok(rows) = <[f64; 16]>::try_from(numbers.as_slice()) {
            DMat4::from_cols_array(&rows).transpose()
        } else if let Ok(rows) = <[f64; 9]>::try_from(numbers.as_slice()) {
            DMat4::from_mat3(DMat3::from_cols_array(&rows).transpose())
        } else {
            let message =
                format!("{} numbers where 16 or 9 are expected, row by row", numbers.len());
            return Err(self.error(message));
        };
        if matrix.row(3) == DVec4::W {
            Ok(matrix)
        } else {
            Err(self.error("the last row must be 0 0 0 1: transforms cannot contain perspective"))
        }
    }
}

/// The factor by which a transform scales all lengths alike; `None` when it does not.
pub(super) fn uniform_scale(transform: &DMat4) -> Option<f64> {
    /// Transforms are written down with six or seven digits.
    const TOLERANCE: f64 = 1e-5;
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = DMat3::from_mat4(*transform);
    let scale = DMat3::from_mat4(*transform).determinant().abs().cbrt();
    let lengths = DVec3::new(x.length(), y.length(), z.length()) - scale;
    let angles = DVec3::new(x.dot(y), y.dot(z), z.dot(x)) / (scale * scale);
    let uniform =
        lengths.abs().max_element() <= TOLERANCE * scale && angles.abs().max_element() <= TOLERANCE;
    uniform.then_some(scale)
}
