//! The numbers behind one path, as text.

use std::io::{self, Write as _};
use std::time::Duration;

use anyhow::{Context as _, bail};
use common::{Notice, PathDetail, PathId, TracerEvent};
use proto::ViewerEvent;
use serde_json::{Value, json};

use crate::source::connection::{Session, SessionError};
use crate::source::selection::numbers_text;

/// A daemon that takes longer to answer does not know the question.
const PATIENCE: Duration = Duration::from_secs(10);

/// Asks for the numbers behind a path, prints them, and leaves. That the path is gone is an error.
pub(super) async fn print(mut session: Session, path: PathId, json: bool) -> anyhow::Result<()> {
    if !session.say(ViewerEvent::Inspect(path)) {
        bail!("the daemon does not accept requests");
    }
    let answer = async {
        loop {
            if let TracerEvent::Notice(Notice::Detail(reply)) = session.next().await?
                && reply.path == path
            {
                return Ok::<_, SessionError>(reply.found);
            }
        }
    };
    let Ok(found) = tokio::time::timeout(PATIENCE, answer).await else {
        bail!("the daemon does not answer; it may be older than this viewer");
    };
    let found = found?;
    session.leave().await;
    let detail = match found {
        Ok(detail) => detail,
        Err(why) => bail!("{why}"),
    };
    let text =
        if json { format!("{}\n", detail_json(path, &detail)) } else { numbers_text(&detail) };
    let written = io::stdout().write_all(text.as_bytes());
    written.context("cannot write to the standard output")
}

pub(super) fn detail_json(path: PathId, detail: &PathDetail) -> Value {
    let vertices = detail.vertices.iter().enumerate().map(|(j, vertex)| {
        let (light, eye) = (detail.light_throughput(j), detail.eye_throughput(j));
        json!({
            "color": [vertex.color.r, vertex.color.g, vertex.color.b],
            "light_pdf": vertex.light_pdf,
            "light_weight": vertex.light_weight,
            "light_throughput": [light.r, light.g, light.b],
            "eye_pdf": vertex.eye_pdf,
            "eye_weight": vertex.eye_weight,
            "eye_throughput": [eye.r, eye.g, eye.b],
            "connection": vertex.connection,
        })
    });
    json!({
        "event": "path detail",
        "path": path.to_string(),
        "luminance": detail.luminance(),
        "vertices": vertices.collect::<Vec<_>>(),
        "geometry": detail.geometry,
        "reciprocal": detail.reciprocals,
    })
}
