//! The numbers behind a path.

use common::{DetailReply, MAX_VERTICES, PathDetail, PathId, VertexDetail};

use super::{WireError, camera, check};
use crate::v1;

impl From<&DetailReply> for v1::PathDetail {
    fn from(reply: &DetailReply) -> Self {
        let path = Some(reply.path.into());
        match &reply.found {
            Ok(detail) => Self {
                path,
                error: String::new(),
                vertices: detail.vertices.iter().map(Into::into).collect(),
                geometry: detail.geometry.clone(),
                reciprocal: detail.reciprocals.clone(),
            },
            Err(error) => {
                Self { path, error: check::cut(error, check::MAX_REASON), ..Self::default() }
            }
        }
    }
}

impl TryFrom<v1::PathDetail> for DetailReply {
    type Error = WireError;

    fn try_from(wire: v1::PathDetail) -> Result<Self, WireError> {
        let path: PathId = check::required("path_detail.path", wire.path)?.into();
        if !wire.error.is_empty() {
            let error = check::text("path_detail.error", wire.error, check::MAX_REASON)?;
            return Ok(Self { path, found: Err(error) });
        }
        let count = check::within(
            "path_detail.vertices",
            wire.vertices.len().try_into().unwrap_or(u32::MAX),
            2,
            MAX_VERTICES as u32,
        )? as usize;
        check::exactly("path_detail.geometry", wire.geometry.len(), count - 1)?;
        check::exactly("path_detail.reciprocal", wire.reciprocal.len(), count)?;
        for &number in wire.geometry.iter().chain(&wire.reciprocal) {
            check::not_negative("path_detail", number)?;
        }
        check::positive("path_detail.reciprocal", wire.reciprocal.iter().sum())?;
        let vertices =
            wire.vertices.into_iter().map(TryInto::try_into).collect::<Result<_, WireError>>()?;
        let detail = PathDetail { vertices, geometry: wire.geometry, reciprocals: wire.reciprocal };
        Ok(Self { path, found: Ok(detail) })
    }
}

impl From<&VertexDetail> for v1::VertexDetail {
    fn from(vertex: &VertexDetail) -> Self {
        Self {
            color: Some(vertex.color.into()),
            light_pdf: vertex.light_pdf,
            light_weight: vertex.light_weight,
            eye_pdf: vertex.eye_pdf,
            eye_weight: vertex.eye_weight,
            connection: vertex.connection,
        }
    }
}

impl TryFrom<v1::VertexDetail> for VertexDetail {
    type Error = WireError;

    fn try_from(wire: v1::VertexDetail) -> Result<Self, WireError> {
        let number = |found| check::not_negative("vertex_detail", found);
        Ok(Self {
            color: camera::color("vertex_detail.color", wire.color)?,
            light_pdf: number(wire.light_pdf)?,
            light_weight: number(wire.light_weight)?,
            eye_pdf: number(wire.eye_pdf)?,
            eye_weight: number(wire.eye_weight)?,
            connection: number(wire.connection)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use common::{ChainId, Notice, Rgb, TracerEvent};
    use prost::Message as _;

    use super::*;
    use crate::ViewerEvent;

    fn reply() -> DetailReply {
        let vertex = |j: f64| VertexDetail {
            color: Rgb::new(0.5, 0.25, j),
            light_pdf: 0.1 + j,
            light_weight: 3.0,
            eye_pdf: 1e-12,
            eye_weight: 1e12,
            connection: 0.3,
        };
        let detail = PathDetail {
            vertices: vec![vertex(0.0), vertex(1.0), vertex(2.0)],
            geometry: vec![1e-7, 0.5],
            reciprocals: vec![0.0, 2.5, 1.0],
        };
        let path = PathId { chain: ChainId::EXPLORER, epoch: 2, step: 1 << 50 };
        DetailReply { path, found: Ok(detail) }
    }

    fn travel(wire: &v1::PathDetail) -> Result<DetailReply, WireError> {
        let bytes = wire.encode_to_vec();
        v1::PathDetail::decode(bytes.as_slice()).expect("our own bytes").try_into()
    }

    #[test]
    fn questions_and_answers_travel() {
        let question = ViewerEvent::Inspect(reply().path);
        let asked = ViewerEvent::try_from(v1::ViewerMessage::from(question.clone()));
        assert_eq!(asked, Ok(question));
        let gone = DetailReply { found: Err("it is gone".to_owned()), ..reply() };
        for reply in [reply(), gone] {
            let event = TracerEvent::Notice(Notice::Detail(Box::new(reply)));
            assert_eq!(TracerEvent::try_from(v1::TracerMessage::from(&event)), Ok(event));
        }
        let nothing = v1::viewer_message::Kind::InspectPath(v1::InspectPath { path: None });
        let nothing = v1::ViewerMessage { kind: Some(nothing) };
        assert!(ViewerEvent::try_from(nothing).is_err(), "which path?");
    }

    #[test]
    fn answers_that_make_no_sense_are_refused() {
        let good = v1::PathDetail::from(&reply());
        assert_eq!(travel(&good), Ok(reply()));
        let spoil = |spoil: fn(&mut v1::PathDetail)| {
            let mut wire = good.clone();
            spoil(&mut wire);
            travel(&wire)
        };
        let bad: [fn(&mut v1::PathDetail); 9] = [
            |wire| wire.path = None,
            |wire| wire.vertices.clear(),
            |wire| wire.vertices = vec![wire.vertices[0]; MAX_VERTICES + 1],
            |wire| wire.geometry.push(1.0),
            |wire| wire.reciprocal.truncate(2),
            |wire| wire.geometry[0] = f64::NAN,
            |wire| wire.reciprocal = vec![0.0; 3],
            |wire| wire.vertices[1].light_pdf = -1.0,
            |wire| wire.vertices[1].color = None,
        ];
        for (number, bad) in bad.into_iter().enumerate() {
            assert!(spoil(bad).is_err(), "mistake {number} was taken");
        }
    }
}
