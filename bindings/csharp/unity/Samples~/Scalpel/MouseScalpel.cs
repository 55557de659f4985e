using Sunder;
using Sunder.Unity;
using UnityEngine;

/// <summary>Drag across a character, and it is torn while it moves. Put it on the camera.</summary>
public sealed class MouseScalpel : MonoBehaviour
{
  [SerializeField] TearableCharacter character = null;
  [Tooltip("Below the surface, metres")]
  [SerializeField] float depth = 0.03f;
  [Tooltip("Of the gap, metres")]
  [SerializeField] float width = 0.004f;

  public TearableCharacter Character { get { return character; } set { character = value; } }

  void Update()
  {
    Ray ray = Camera.main.ScreenPointToRay(Input.mousePosition);
    TearHit hit = new TearHit();
    bool isOn = Input.GetMouseButton(0) && character.Raycast(ray, 100, out hit);
    if (!isOn)
    {
      character.EndStroke(this);
      return;
    }
    // From outside the surface to how deep it reaches, along the ray.
    BladePosition blade = character.BladeToModel(hit.Point - depth * ray.direction, hit.Point + depth * ray.direction);
    if (character.ExtendStroke(this, blade, Time.deltaTime)) return;
    TearOptions options = TearOptions.Default;
    options.Width = width;
    options.WallDepth = depth;
    character.BeginStroke(this, blade, options);  // unless another one, as of a blade, goes on
  }

  void OnDisable()
  {
    if (character != null) character.EndStroke(this);
  }
}
